// An instructor commands a live session: checkpoints, tools, pause, roles. haptic_server, device_daemon and
// render_client are processes, the test itself is a viewer.
#include <gtest/gtest.h>
#include <signal.h>

#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/node_meshes.h"
#include "tests/support/ply_reader.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;
using test::Process;
using test::run;
using test::TemporaryFolder;

// Takes in all triangles, however they are ordered in their nodes.
uint64_t surfaceHash(const std::vector<NodeMesh>& nodes) {
    std::map<uint32_t, const NodeMesh*> by_leaf;
    for (const NodeMesh& node : nodes)
        if (!node.isEmpty()) by_leaf[node.leaf] = &node;
    StateHash hash;
    for (const auto& [leaf, node] : by_leaf) {
        hash.addBytes(&leaf, sizeof leaf);
        NodeMesh plain = *node;
        plain.materials.clear();  // which bone was milled a file does not say
        for (const auto& key : test::triangleKeys(plain)) hash.addBytes(&key, sizeof key);
    }
    return hash.value();
}

// The simulated hand mills a slab (top at z = 2 mm) slowly for as long as the test takes.
class Instructor : public testing::Test {
  protected:
    Instructor() {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        writeScene("s.textproto", "slab.nrrd");
    }
    void writeScene(const std::string& name, const std::string& volume) const {
        const auto waypoint = [](int time_s, double z_mm, bool removes) {
            return "  waypoint { time_s: " + std::to_string(time_s) +
                   " p_WT_mm { x: 0 y: 0.1 z: " + std::to_string(z_mm) +
                   " } q_WT { w: 0.70710678 x: 0.70710678 } remove: " + (removes ? "true" : "false") + " }\n";
        };
        test::writeFile(folder_ / name,
                        "name: \"instructed\" effects { time_removal {} } volume { path: \"" + volume +
                            "\" window_low: 0 window_high: 65535 iso_value: 32768 }\n"
                            "tool { name: \"coarse\" }\ntool { name: \"fine\" burr_radius_mm: 0.5 "
                            "sdf_spacing_mm: 0.0625 }\n"
                            "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                            "simulated_operator {\n" +
                            waypoint(0, 3.6, false) + waypoint(1, 2.8, true) + waypoint(30, -1, true) +
                            waypoint(300, -1, true) + "}\n");
    }
    std::vector<std::string> server(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"haptic_server", "--scene", folder_ / "s.textproto",
                                           "--session",     session(), "--domain",
                                           domain()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    std::vector<std::string> daemon() const {
        return {"device_daemon",         "--device",  "simulated", "--scene",
                folder_ / "s.textproto", "--session", session()};
    }
    static Finished command(const std::string& text, const std::string& role = "operator") {
        return run({"render_client", "--command", text, "--role", role, "--session", session(), "--domain",
                    domain()});
    }
    static void expectDone(const std::string& text, const std::string& role = "operator") {
        const Finished answer = command(text, role);
        EXPECT_EQ(answer.exit_code, 0) << text << ": " << answer.out << answer.err;
    }
    static void expectRefused(const std::string& text, const std::string& role, const std::string& why) {
        const Finished answer = command(text, role);
        EXPECT_EQ(answer.exit_code, 1) << text;
        EXPECT_NE(answer.out.find("refused: " + why), std::string::npos) << answer.out << answer.err;
    }
    static std::string session() { return std::to_string(testSession()); }
    static std::string domain() { return std::to_string(testDomain()); }

    const topics::Status& status() { return *probe_.subscriber.status(); }
    bool hasSession() {
        return probe_.pollUntil(
            [this] { return probe_.subscriber.status() && probe_.subscriber.sceneInfo(); });
    }
    bool isRemoved(double mm3) {
        return probe_.pollUntil([&] { return status().removed_mm3() > mm3; });
    }
    bool isPaused(bool pause) {
        return probe_.pollUntil([&] { return status().is_milling_paused() == pause; });
    }
    uint64_t shownHash() const {
        std::vector<NodeMesh> nodes;
        for (const auto& [leaf, node] : probe_.nodes) nodes.push_back(node);
        return surfaceHash(nodes);
    }
    // It is the hash when nothing has changed for a while.
    uint64_t settledHash() {
        using namespace std::chrono_literals;
        auto since = std::chrono::steady_clock::now();
        uint32_t changes = probe_.changes;
        EXPECT_TRUE(probe_.pollUntil([&] {
            const auto now = std::chrono::steady_clock::now();
            if (probe_.changes != changes || !probe_.subscriber.isComplete()) since = now;
            changes = probe_.changes;
            return now - since > 1s;
        }));
        return shownHash();
    }
    // The hash is that of what the server would stream.
    uint64_t hashOfFile(const std::string& volume) {
        writeScene("saved.textproto", volume);
        const auto bone = setUpScene(loadScene(folder_ / "saved.textproto")).bone;
        std::vector<NodeMesh> nodes;
        Mesher(bone->volume, bone->lattice, MeshGrid::kStreamedStepsPerCell).pass([&](NodeMesh&& node) {
            nodes.push_back(std::move(node));
        });
        return surfaceHash(nodes);
    }

    TemporaryFolder folder_;
    ClientProbe probe_;
};

TEST_F(Instructor, GoesBackToACheckpointAfterMillingOnWithAnotherTool) {
    Process server_process(server({"--save-volume", folder_ / "end.nrrd"}));
    ASSERT_TRUE(hasSession());
    EXPECT_EQ(settledHash(), hashOfFile("slab.nrrd"));
    Process daemon_process(daemon());
    EXPECT_EQ(probe_.subscriber.sceneInfo()->tool_names_size(), 2);
    EXPECT_EQ(probe_.subscriber.sceneInfo()->tool_index(), 0u);
    EXPECT_EQ(probe_.subscriber.sceneInfo()->burr_radius_m(), 1e-3);
    const uint32_t revision = probe_.subscriber.sceneInfo()->revision();

    ASSERT_TRUE(isRemoved(0.1));
    expectDone("checkpoint");  // while it mills
    ASSERT_TRUE(isRemoved(0.4));
    expectDone("pause");
    ASSERT_TRUE(isPaused(true));
    expectDone("checkpoint");
    ASSERT_TRUE(probe_.pollUntil([&] { return status().checkpoints_size() == 2; }));
    const topics::Checkpoint first = status().checkpoints(0), second = status().checkpoints(1);
    EXPECT_LT(first.id(), second.id());
    EXPECT_GT(first.session_s(), 0);
    EXPECT_LT(first.session_s(), second.session_s());
    EXPECT_GT(first.removed_mm3(), 0.1);
    EXPECT_EQ(second.removed_mm3(), status().removed_mm3());
    const uint64_t at_checkpoint = settledHash();

    expectDone("tool fine");
    ASSERT_TRUE(probe_.pollUntil([&] { return probe_.subscriber.sceneInfo()->tool_index() == 1; }));
    EXPECT_GT(probe_.subscriber.sceneInfo()->revision(), revision);
    EXPECT_EQ(probe_.subscriber.sceneInfo()->burr_radius_m(), 0.5e-3);
    expectDone("resume");
    ASSERT_TRUE(isRemoved(second.removed_mm3() + 0.05));
    expectDone("pause");
    EXPECT_NE(settledHash(), at_checkpoint);
    expectDone("restore 1");
    EXPECT_TRUE(probe_.pollUntil([&] { return status().removed_mm3() == first.removed_mm3(); }));
    expectDone("restore last");
    EXPECT_TRUE(probe_.pollUntil([&] { return status().removed_mm3() == second.removed_mm3(); }));
    EXPECT_TRUE(probe_.pollUntil([&] { return shownHash() == at_checkpoint; }));

    expectRefused("restore 9", "operator", "there is no checkpoint 9");
    expectRefused("reset", "viewer", "a viewer only looks");
    expectRefused("shutdown", "operator", "only an instructor");
    EXPECT_EQ(command("tool drill").exit_code, 2);
    EXPECT_GT(status().session_s(), second.session_s());
    expectDone("shutdown", "instructor");
    const Finished finished = server_process.wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(hashOfFile("end.nrrd"), at_checkpoint);
    EXPECT_NE(hashOfFile("slab.nrrd"), at_checkpoint);
}

TEST_F(Instructor, ExportsTheBoneWhileTheSessionGoesOn) {
    std::filesystem::create_directory(folder_ / "results");
    std::filesystem::create_symlink("/dev/full", folder_ / "end.ply");
    Process server_process(
        server({"--export-dir", folder_ / "results", "--save-difference", folder_ / "end.nrrd", "--save-mesh",
                folder_ / "end.ply", "--report", folder_ / "report.json"}));
    ASSERT_TRUE(hasSession());
    Process daemon_process(daemon());
    ASSERT_TRUE(isRemoved(0.1));
    expectDone("pause");
    ASSERT_TRUE(isPaused(true));
    expectDone("checkpoint");
    const uint64_t paused = settledHash();
    expectDone("resume");
    ASSERT_TRUE(isRemoved(status().removed_mm3() + 0.1));
    expectDone("pause");
    expectDone("restore last");
    expectDone("export cut");  // as it will be when all is put back
    EXPECT_EQ(hashOfFile("results/cut.nrrd"), paused);
    EXPECT_TRUE(test::readPly(folder_ / "results/cut.ply").isClosed());
    expectRefused("export cut", "operator", "cut.stl is there already");
    expectRefused("export ../cut", "operator", "'../cut' is no name");
    expectRefused("export other", "viewer", "a viewer only looks");
    const uint64_t ticks = status().ticks();
    EXPECT_TRUE(probe_.pollUntil([&] { return status().ticks() > ticks; }));
    expectDone("shutdown", "instructor");
    const Finished finished = server_process.wait();
    EXPECT_EQ(finished.exit_code, 1) << finished.err;  // the disk is full for one of its files
    EXPECT_NE(finished.err.find("end.ply"), std::string::npos) << finished.err;
    EXPECT_GT(std::filesystem::file_size(folder_ / "end.nrrd"), 100u);
    EXPECT_GT(std::filesystem::file_size(folder_ / "report.json"), 100u);
}

// The stream is slow enough that meshes always wait, and fast enough that those of the end need no 0.5 s.
TEST_F(Instructor, EndingWhileItMillsShowsTheBoneThatIsInTheFiles) {
    Process server_process(server({"--save-volume", folder_ / "end.nrrd", "--stream-mbit-per-s", "0.15"}));
    ASSERT_TRUE(hasSession());
    ASSERT_TRUE(probe_.pollUntil([this] { return probe_.subscriber.isComplete(); }));
    Process daemon_process(daemon());
    ASSERT_TRUE(isRemoved(0.1));
    server_process.signal(SIGTERM);
    const Finished finished = server_process.wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const uint64_t end = hashOfFile("end.nrrd");
    EXPECT_NE(end, hashOfFile("slab.nrrd"));
    EXPECT_TRUE(probe_.pollUntil([&] { return probe_.subscriber.isComplete() && shownHash() == end; }));
}

TEST_F(Instructor, ShowsNotesAndStrokesToEveryoneAlsoToWhoComesLater) {
    Process server_process(server({}));
    ASSERT_TRUE(hasSession());
    topics::Command stroke;
    for (const float value : {0.f, 0.f, 2e-3f, 1e-3f, 0.f, 2e-3f})
        stroke.mutable_add_remark()->add_points_m(value);
    probe_.subscriber.sendCommand(stroke);
    ASSERT_TRUE(probe_.pollUntil([&] { return probe_.subscriber.remarks().size() == 1; }));
    EXPECT_EQ(probe_.subscriber.remarks().at(0).points_m_size(), 6);
    EXPECT_EQ(probe_.subscriber.remarks().at(0).role(), topics::Viewer::OPERATOR);
    expectDone("note mind the nerve", "instructor");
    ClientProbe late;
    ASSERT_TRUE(late.pollUntil([&] { return late.subscriber.remarks().size() == 2; }));
    EXPECT_EQ(late.subscriber.remarks().at(1).note(), "mind the nerve");
    EXPECT_EQ(late.subscriber.remarks().at(1).role(), topics::Viewer::INSTRUCTOR);
    expectRefused("note hello", "viewer", "a viewer only looks");
    expectRefused("note " + std::string(301, 'x'), "operator", "the note has 301 letters; 300 at most");
    expectRefused("erase 7", "operator", "there is no note or stroke 7");
    expectDone("erase 1");
    ASSERT_TRUE(late.pollUntil([&] { return late.subscriber.remarks().size() == 1; }));
    ASSERT_TRUE(probe_.pollUntil([&] { return probe_.subscriber.remarks().contains(1); }));
    expectDone("erase all");
    EXPECT_TRUE(late.pollUntil([&] { return late.subscriber.remarks().empty(); }));
}

TEST_F(Instructor, AloneCommandsInAnExamination) {
    Process server_process(server({"--instructor-only"}));
    expectRefused("pause", "operator", "only instructors command this session");
    expectRefused("pause", "viewer", "only instructors command this session");
    expectDone("pause", "instructor");
    expectDone("shutdown", "instructor");
    EXPECT_EQ(server_process.wait().exit_code, 0);
}

}  // namespace
}  // namespace bonemill
