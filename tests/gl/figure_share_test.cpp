// Counts how much of the picture the figures take: a sixth of 1280x800 at most, in every shipped scene and
// in every state that a session can be in. BONEMILL_SHOW_FIGURES=FOLDER writes the pictures, and says how
// much it was.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "common/config/scene_file.h"
#include "common/config/scene_tools.h"
#include "common/device_messages/device_state.h"
#include "render_client/hand/controls/key_table.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/milled_scene.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

constexpr int kShareWidth = 1280, kShareHeight = 800;
constexpr double kMaxShare = 1.0 / 6;
constexpr uint32_t kEveryEvent = 0x1f;

topics::ToolState toolWithDamage(uint32_t events) {
    topics::ToolState tool = test::toolWithEveryEffect(events);
    tool.mutable_effects()->set_damaged_mm3(0.1);
    return tool;
}

// Every line that a task can have while it is done.
void addTask(topics::TaskState& task) {
    task.set_time_left_s(59);
    for (uint32_t role = 0; role < 5; ++role) {
        topics::TaskState::Zone& zone = *task.add_zones();
        zone.set_role(role);
        zone.set_bone_mm3(1000);
        zone.set_removed_mm3(123);
    }
    task.add_gates()->set_state(topics::TaskState::Gate::BROKEN);
}

class FigureShare : public testing::Test {
  protected:
    FigureShare() : context_(kShareWidth, kShareHeight), scene_(context_.gl()) {
        scene_.settings().quality = Quality::kQuick;
        scene_.settings().show_force = false;
        info_ = test::makeSceneInfo("milled block", {0, 0, 0}, {0.01, 0.01, 0.01});
        info_.add_tool_names("round burr 6 mm");
        info_.add_tool_names("round burr 3 mm");
        info_.add_materials()->set_name("facial nerve");
        status_ = test::makeStatus();
        status_.set_session_s(3723);
        addTask(*status_.mutable_task());
        tool_ = toolWithDamage(0);
        for (int i = 0; i < 20; ++i)
            watchers_.push_back(
                test::makeWatcher("student " + std::to_string(i), topics::Viewer::OPERATOR, 30));
    }

    Picture draw(bool has_figures) {
        scene_.settings().show_hud = has_figures;
        scene_.draw(kShareWidth, kShareHeight, 1);
        return context_.read();
    }
    // Returns which part of the picture's pixels differs from the picture without any figures.
    double share() {
        scene_.setSceneInfo(info_);
        if (!bare_) bare_ = draw(false);
        scene_.setStatus(status_);
        tool_.set_tick(++tick_);
        scene_.setToolState(tool_);
        scene_.setWatchers(watchers_);
        scene_.setFrameRate(59.6);
        scene_.setConnection(connection_);
        const Picture with_figures = draw(true);
        size_t count = 0;
        for (int y = 0; y < kShareHeight; ++y)
            for (int x = 0; x < kShareWidth; ++x) count += with_figures.at(x, y) != bare_->at(x, y);
        last_ = with_figures;
        return double(count) / (kShareWidth * kShareHeight);
    }
    void expectQuiet(const std::string& what) {
        const double part = share();
        EXPECT_GT(part, 0.01) << what << ": nothing is shown";
        EXPECT_LT(part, kMaxShare) << what;
        const char* const folder = std::getenv("BONEMILL_SHOW_FIGURES");
        if (!folder) return;
        std::printf("%-40s %.1f %%\n", what.c_str(), 100 * part);
        writePng(*last_, std::filesystem::path(folder) / (what + ".png"));
    }
    // The server sends this of a scene; of its effects there is every figure.
    void show(const scene::Scene& scene) {
        info_.set_name(scene.name());
        info_.clear_tool_names();
        for (const std::string& name : toolNamesOf(scene)) info_.add_tool_names(name);
        *info_.mutable_materials() = scene.material();
        if (!scene.has_effects()) tool_.clear_effects();
    }

    OsmesaContext context_;
    RenderScene scene_;
    topics::SceneInfo info_;
    topics::Status status_;
    topics::ToolState tool_;
    std::vector<topics::Viewer> watchers_;
    Connection connection_ = Connection::kLive;
    uint64_t tick_ = 0;  // each picture shows another state of the tool
    std::optional<Picture> bare_, last_;
};

TEST_F(FigureShare, OfEveryShippedScene) {
    size_t scenes = 0;
    for (const auto& file : std::filesystem::directory_iterator(test::sourceDir() + "/deploy/scenes")) {
        if (file.path().extension() != ".textproto") continue;
        show(loadScene(file.path()).scene);
        expectQuiet(file.path().filename());
        ++scenes;
    }
    EXPECT_GT(scenes, 5u);
}

TEST_F(FigureShare, WithTheRestUnfolded) {
    scene_.settings().show_details = true;
    status_.set_preset("gradient s=2 q=2 grid x1 float iterations=3 ccd grid x1 float iterations=3 ccd");
    status_.mutable_device()->set_name("Touch");
    status_.mutable_device()->set_state(uint32_t(SafetyState::kEngaged));
    expectQuiet("all figures");
    tool_ = toolWithDamage(kEveryEvent);
    scene_.setNotice(HudNotice{"accuracy exact: refused: the scene says accuracy.switchable: false", {}});
    expectQuiet("all figures with an alert");
    scene_.settings().show_details = false;
    scene_.settings().show_watchers = true;
    expectQuiet("watchers with an alert");
}

TEST_F(FigureShare, WhereTheSessionIsFaulty) {
    status_.set_faults(0x7fff);
    status_.set_fault_text(
        "overrun, stale_device, bad_device_pose, solve, motion_clamped, force_clamped, shell_overflow");
    status_.set_device_stale(true);
    status_.mutable_device()->set_name("Touch");
    status_.mutable_device()->set_state(uint32_t(SafetyState::kProtectiveStop));
    status_.mutable_device()->set_stop_cause(uint32_t(StopCause::kEnergy));
    tool_ = toolWithDamage(kEveryEvent);
    tool_.set_device_state(uint32_t(SafetyState::kProtectiveStop));
    tool_.set_stop_cause(uint32_t(StopCause::kEnergy));
    expectQuiet("faults");
    scene_.settings().show_details = true;
    scene_.setNotice(HudNotice{"accuracy exact: refused: the scene says accuracy.switchable: false", {}});
    expectQuiet("faults with all figures and a notice");
    scene_.settings().stereo = StereoMode::kSideBySide;
    bare_.reset();
    expectQuiet("faults in both eyes");
}

TEST_F(FigureShare, HowEverItStandsWithTheServer) {
    for (const Connection connection :
         {Connection::kNoServer, Connection::kReceiving, Connection::kServerLost, Connection::kServerEnded}) {
        connection_ = connection;
        expectQuiet("connection " + std::to_string(int(connection)));
    }
    connection_ = Connection::kNoServer;
    scene_.setSought({1, 0, "classroom", "eth7", true});
    scene_.setHint(HudHint{startRows()});
    expectQuiet("waiting");
}

TEST_F(FigureShare, IsOnlyTheOrientationMarkerInSideBySideStereo) {
    scene_.settings().stereo = StereoMode::kSideBySide;
    EXPECT_LT(share(), 0.01);
    EXPECT_GT(share(), 0);
    tool_ = toolWithDamage(kEveryEvent);
    expectQuiet("an alert for both eyes");
}

TEST_F(FigureShare, WithTheHintOnMouseAndKeys) {
    scene_.setHint(HudHint{hintRows()});
    tool_ = toolWithDamage(kEveryEvent);
    scene_.setNotice(
        HudNotice{"ARES emulator holds the tool: device_daemon --device pointer gives it to the mouse, when "
                  "it is started anew",
                  {}});
    expectQuiet("hint");
}

}  // namespace
}  // namespace bonemill
