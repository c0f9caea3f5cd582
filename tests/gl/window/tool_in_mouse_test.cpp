// The viewer's real window on a display in memory, where the mouse of xdotool holds the tool: what it tells
// the device, and, with server and daemon behind it, that it mills.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>

#include "common/device_messages/device_messages.h"
#include "device_daemon/hands/pointer/hand_wish.h"
#include "render_client/hand/controls/tool_hold.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/gl/window/mouse_session.h"
#include "tests/gl/window/shown_session.h"

namespace bonemill {
namespace {

using test::Process;
using test::viewerWords;
using test::VirtualDisplay;
using test::waitFor;

constexpr int kScreenWidth = test::kMouseScreenWidth, kScreenHeight = test::kMouseScreenHeight;

// Hears what viewers want of the tool.
class WishReader {
  public:
    WishReader() : participant_(testDomain()), reader_(participant_) {}

    const std::optional<HandWish>& newest() {
        reader_.take(256, [this](const dds::HandPointerSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != testSession()) return;
            const auto wish = parseHandWish(dds::payloadOf(sample), sample.sender);
            ASSERT_TRUE(wish);
            newest_ = wish;
        });
        return newest_;
    }

  private:
    dds::Participant participant_;
    dds::Reader<dds::HandPointerSample> reader_;
    std::optional<HandWish> newest_;
};

class ToolInMouse : public testing::Test {
  protected:
    bool waitForWish(const std::function<bool(const HandWish&)>& holds) {
        return waitFor([&] { return wishes_.newest() && holds(*wishes_.newest()); });
    }
    bool isUnder(const HandWish& wish, const PixelPoint& cursor) {
        OrbitCamera camera = firstViewOfBlock();
        const PictureView view{camera.view(), kScreenWidth, kScreenHeight};
        const PixelPoint tool = view.pixelOf(wish.X_WT.position);
        return std::hypot(tool.x - cursor.x, tool.y - cursor.y) < 1;
    }
    static OrbitCamera firstViewOfBlock() {
        const Eigen::AlignedBox3d box(test::kBlockCenter - Eigen::Vector3d::Constant(test::kBlockRadius),
                                      test::kBlockCenter + Eigen::Vector3d::Constant(test::kBlockRadius));
        std::vector<Eigen::Vector3d> corners;
        for (int i = 0; i < 8; ++i) corners.push_back(box.corner(Eigen::AlignedBox3d::CornerType(i)));
        ViewWish wish;
        wish.azimuth = test::milledInfo().camera().azimuth_rad();
        wish.elevation = test::milledInfo().camera().elevation_rad();
        return firstView(wish, Eigen::Vector3d::UnitZ(), corners, double(kScreenWidth) / kScreenHeight);
    }

    VirtualDisplay display_{kScreenWidth, kScreenHeight};
    WishReader wishes_;
};

TEST_F(ToolInMouse, TheWindowTellsTheDeviceWhatTheMouseWants) {
    test::ShownSession session;
    session.giveToolTo("mouse in the viewer", DeviceKind::kPointer);
    Process viewer(viewerWords({"--name", "me"}));
    ASSERT_TRUE(waitForWish([](const HandWish& w) { return w.is_holding && w.may_hold; }))
        << "it holds the tool by itself: " << viewer.errSoFar();
    EXPECT_EQ(wishes_.newest()->buttons, 0u);
    const double front = (wishes_.newest()->X_WT.position - test::kBlockCenter).norm();
    EXPECT_TRUE(front > test::kBlockRadius * 0.5 && front < 3 * test::kBlockRadius) << front;

    display_.type({"mousemove", "240", "170"});
    EXPECT_TRUE(waitForWish([&](const HandWish& w) { return isUnder(w, {240, 170}); }));
    display_.type({"mousemove", "300", "100", "mousedown", "1"});
    EXPECT_TRUE(waitForWish([&](const HandWish& w) {
        return isUnder(w, {300, 100}) && w.buttons == kButtonRemove;
    }));
    display_.type({"mouseup", "1", "keydown", "a"});
    EXPECT_TRUE(waitForWish([](const HandWish& w) { return w.buttons == kButtonAdd; }));
    display_.type({"keyup", "a"});
    EXPECT_TRUE(waitForWish([](const HandWish& w) { return w.buttons == 0; }));

    const Pose before = wishes_.newest()->X_WT;
    display_.type({"click", "4"});
    EXPECT_TRUE(waitForWish([&](const HandWish& w) {
        return std::abs((w.X_WT.position - before.position).norm() - 0.5 * test::kBurrRadius) < 1e-6 &&
               isUnder(w, {300, 100});
    })) << "the wheel moves along the line of sight";
    display_.type({"keydown", "space", "mousemove", "100", "100"});
    display_.type({"keyup", "space", "mousemove_relative", "30", "0"});
    EXPECT_TRUE(waitForWish([&](const HandWish& w) { return isUnder(w, {130, 100}); })) << "the clutch";
    display_.type({"mousedown", "3", "mousemove_relative", "60", "0", "mouseup", "3"});
    EXPECT_TRUE(waitForWish([&](const HandWish& w) {
        return w.X_WT.rotation.angularDistance(before.rotation) > 0.3 && isUnder(w, {130, 100});
    })) << "the right button turns";
    display_.type({"key", "g"});
    EXPECT_TRUE(waitForWish([](const HandWish& w) { return !w.is_holding; }));
    display_.type({"mousemove", "240", "170", "key", "g"});
    EXPECT_TRUE(waitForWish([&](const HandWish& w) {
        return w.is_holding && isUnder(w, {240, 170});
    })) << "it begins under the cursor";
    viewer.signal(SIGTERM);
    EXPECT_EQ(viewer.wait().exit_code, 0);
    EXPECT_TRUE(waitForWish([](const HandWish& w) { return !w.is_holding; })) << "it lets go when it ends";
}

TEST_F(ToolInMouse, WithoutSuchADeviceTheMouseIsTheCamerasAndAViewerNeverHolds) {
    test::ShownSession session;
    session.giveToolTo("ARES emulator", DeviceKind::kAres);
    Process viewer(viewerWords({"--name", "me"}));
    SceneSubscriber observer({.domain = testDomain(), .session = testSession(), .name = "observer"});
    const auto isComplete = [&] {
        observer.poll();
        for (const topics::Viewer& other : observer.viewers())
            if (other.is_complete()) return true;
        return false;
    };
    ASSERT_TRUE(waitFor(isComplete));
    display_.type({"mousemove", "240", "170", "key", "g"});
    EXPECT_TRUE(
        waitFor([&] { return viewer.errSoFar().find("ARES emulator holds the tool") != std::string::npos; }));
    viewer.signal(SIGTERM);
    viewer.wait();

    session.giveToolTo("mouse in the viewer", DeviceKind::kPointer);
    Process pupil(viewerWords({"--name", "pupil", "--role", "viewer"}));
    ASSERT_TRUE(waitFor([&] { return pupil.errSoFar().find("window") != std::string::npos; }));
    ASSERT_TRUE(waitFor(isComplete));
    display_.type({"key", "g"});
    EXPECT_TRUE(waitFor([&] { return pupil.errSoFar().find("A viewer only looks") != std::string::npos; }));
    EXPECT_FALSE(wishes_.newest() && wishes_.newest()->is_holding);
}

TEST_F(ToolInMouse, MillsTheBoneOfALiveSession) {
    test::MouseSession session;
    ASSERT_TRUE(waitForWish([](const HandWish& w) { return w.is_holding; })) << session.viewer().errSoFar();

    SceneSubscriber observer({.domain = testDomain(), .session = testSession(), .name = "observer"});
    const auto removed = [&] {
        observer.poll();
        return observer.status() ? observer.status()->removed_mm3() : 0;
    };
    const auto force = [&] {
        observer.poll();
        return observer.toolState() && observer.toolState()->force_n_size() == 3
                   ? Eigen::Vector3d(observer.toolState()->force_n().data()).norm()
                   : 0;
    };
    for (int i = 0; i < 12; ++i) display_.type({"click", "4"});
    EXPECT_TRUE(waitFor([&] { return force() > 0.5; })) << "the bone is felt: " << session.whatDaemonSaid();
    EXPECT_EQ(removed(), 0);
    display_.type({"mousedown", "1"});
    EXPECT_TRUE(waitFor([&] { return removed() > 0.5; })) << "and milled: " << session.whatServerSaid();

    session.viewer().signal(SIGSTOP);
    EXPECT_TRUE(waitFor([&] {
        observer.poll();
        return observer.toolState() && observer.toolState()->buttons() == 0;
    })) << "a viewer that hangs mills no more";
    session.viewer().signal(SIGCONT);
    display_.type({"mouseup", "1"});
    // The picture that was under way when the viewer was stopped still tells of the button.
    EXPECT_TRUE(waitForWish([](const HandWish& w) { return w.is_holding && w.buttons == 0; }));
    EXPECT_TRUE(waitFor([&] {
        observer.poll();
        return observer.toolState() && observer.toolState()->buttons() == 0;
    }));

    const uint32_t placements = wishes_.newest()->placements;
    topics::Command start;
    start.set_start_attempt("Ann");
    observer.sendCommand(start);
    EXPECT_TRUE(waitFor([&] {
        observer.poll();
        return wishes_.newest() && wishes_.newest()->is_holding && wishes_.newest()->placements > placements;
    })) << "the mouse takes the tool anew: "
        << session.whatDaemonSaid();
    EXPECT_TRUE(waitFor([&] { return force() < 0.01 && removed() == 0; }))
        << "in front of the whole bone: " << force() << " N, " << removed() << " mm3; "
        << session.whatDaemonSaid();
    const test::MouseSession::Ended ended = session.end();
    for (const test::Finished& program : {ended.viewer, ended.daemon, ended.server})
        EXPECT_EQ(program.exit_code, 0) << program.err;
}

}  // namespace
}  // namespace bonemill
