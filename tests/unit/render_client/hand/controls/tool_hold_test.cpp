// The mouse holds the tool: the tool stays under the cursor at every camera, the wheel moves it along the
// line of sight, and the clutch leaves it where it is.
#include "render_client/hand/controls/tool_hold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/device_messages/device_messages.h"
#include "render_client/look/camera/camera.h"
#include "tests/support/controlled_viewer.h"

namespace bonemill {
namespace {

constexpr int kHoldWidth = 900, kHoldHeight = 600;
constexpr double kBurr = 1e-3;  // m
constexpr double kSmallPixel = 1e-6;

Pose at(const Eigen::Vector3d& p_W) {
    return {p_W, Eigen::Quaterniond::Identity()};
}

PictureView viewOf(double azimuth, double elevation, double distance, const Eigen::Vector3d& up = {0, 0, 1}) {
    OrbitCamera camera;
    camera.setUp(up);
    camera.target_W = {0.01, -0.02, 0.03};
    camera.azimuth = azimuth;
    camera.elevation = elevation;
    camera.distance = distance;
    return {camera.view(), kHoldWidth, kHoldHeight};
}

PictureView anyView(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    return viewOf(3 * unit(random), 1.4 * unit(random), 0.1 * std::exp(2 * unit(random)),
                  {unit(random), unit(random), unit(random) + 2});
}

PixelPoint anyPixel(std::mt19937& random) {
    return {std::uniform_real_distribution<double>(0, kHoldWidth)(random),
            std::uniform_real_distribution<double>(0, kHoldHeight)(random)};
}

void expectAt(const PixelPoint& pixel, const PixelPoint& expected, const char* what) {
    EXPECT_NEAR(pixel.x, expected.x, kSmallPixel) << what;
    EXPECT_NEAR(pixel.y, expected.y, kSmallPixel) << what;
}

void press(ToolHold& hold, MouseButton button, bool is_down = true, Modifiers held = {}) {
    hold.handle(MouseButtonEvent{button, is_down, {}, held, 0}, false);
}
void key(ToolHold& hold, Key which, bool is_down = true) {
    hold.handle(KeyEvent{which, is_down, false, {}}, false);
}
void moveTo(ToolHold& hold, const PixelPoint& to) {
    hold.handle(MouseMoveEvent{to}, false);
}

TEST(PictureView, PixelsAndPointsBelongTogether) {
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i) {
        PictureView view = anyView(random);
        view.camera.shift = 0.02 * (i % 3 - 1);  // an eye of stereo
        const PixelPoint pixel = anyPixel(random);
        const Eigen::Vector3d p_W = view.pointAt(pixel, 0.2);
        EXPECT_NEAR(view.depthOf(p_W), 0.2, 1e-12);
        expectAt(view.pixelOf(p_W), pixel, "there and back");
    }
    const PictureView view = viewOf(0.3, 0.2, 0.2);
    expectAt(view.pixelOf(view.camera.target_W()), {kHoldWidth / 2.0, kHoldHeight / 2.0},
             "the target is in the middle");
}

TEST(ToolHold, TheToolStaysUnderTheCursorAtEveryCameraAndDepth) {
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        const PictureView view = anyView(random);
        ToolHold hold;
        hold.lookAt(view);
        hold.begin({view.camera.target_W(), expRotation({0.1, 0.2, 0.3})}, kBurr);
        const double depth = view.depthOf(hold.wish().position);
        for (int k = 0; k < 5; ++k) {
            const PixelPoint cursor = anyPixel(random);
            moveTo(hold, cursor);
            expectAt(view.pixelOf(hold.wish().position), cursor, "moved");
            EXPECT_NEAR(view.depthOf(hold.wish().position), depth, 1e-12) << "across the view's plane";
        }
        const PixelPoint before = view.pixelOf(hold.wish().position);
        hold.handle(ScrollEvent{double(i % 7 - 3)}, false);
        expectAt(view.pixelOf(hold.wish().position), before, "the wheel");
        moveTo(hold, {10, 20});
        expectAt(view.pixelOf(hold.wish().position), {10, 20}, "moved at another depth");
        EXPECT_LT(hold.wish().rotation.angularDistance(expRotation({0.1, 0.2, 0.3})), 1e-9);
    }
}

TEST(ToolHold, TheWheelMovesAlongTheSightByPartsOfTheBurr) {
    const PictureView view = viewOf(0.5, 0.4, 0.2);
    ToolHold hold;
    hold.lookAt(view);
    hold.begin(at(view.camera.target_W()), kBurr);
    const double far = (hold.wish().position - view.camera.eye_W).norm();
    const auto distance = [&] { return (hold.wish().position - view.camera.eye_W).norm() - far; };
    EXPECT_TRUE(hold.handle(ScrollEvent{2}, false));
    EXPECT_NEAR(distance(), 2 * ToolHold::kDepthPerStep * kBurr, 1e-12) << "away from the user is deeper";
    key(hold, keyOf('O'));
    key(hold, keyOf('O'));
    EXPECT_NEAR(distance(), 0, 1e-12);
    key(hold, keyOf('I'));
    EXPECT_GT(distance(), 0);
    for (int i = 0; i < 2000; ++i) hold.handle(ScrollEvent{-1}, false);
    EXPECT_GT(view.depthOf(hold.wish().position), 0) << "never behind the eye";
}

TEST(ToolHold, TheClutchKeepsThePoseAndGivesTheMouseToTheCamera) {
    const PictureView view = viewOf(0.5, 0.4, 0.2);
    ToolHold hold;
    hold.lookAt(view);
    hold.begin(at(view.camera.target_W()), kBurr);
    moveTo(hold, {300, 300});
    const Eigen::Vector3d before = hold.wish().position;
    key(hold, Key::kSpace);
    moveTo(hold, {700, 100});
    EXPECT_EQ(hold.wish().position, before);
    EXPECT_FALSE(hold.handle(ScrollEvent{1}, false));
    EXPECT_FALSE(hold.handle(MouseButtonEvent{MouseButton::kLeft, true, {}, {}, 0}, false));
    EXPECT_EQ(hold.buttons(), 0u);
    EXPECT_EQ(hold.wish().position, before);
    key(hold, Key::kSpace, false);
    moveTo(hold, {710, 100});
    expectAt(view.pixelOf(hold.wish().position), {710, 100}, "it is under the cursor again");
}

TEST(ToolHold, ADraggedCameraLeavesTheToolWhereItIs) {
    ToolHold hold;
    hold.lookAt(viewOf(0.5, 0.4, 0.2));
    hold.begin(at({0.01, -0.02, 0.03}), kBurr);
    const Eigen::Vector3d before = hold.wish().position;
    for (int i = 0; i < 10; ++i) {
        hold.lookAt(viewOf(0.5 + 0.1 * i, 0.4, 0.2));
        hold.handle(MouseMoveEvent{{300.0 + 20 * i, 300}}, true);
    }
    EXPECT_EQ(hold.wish().position, before);
    hold.passOver({5, 5});
    EXPECT_EQ(hold.wish().position, before) << "the panel has the cursor";
}

// A pupil saw it 670 pixels aside.
TEST(ToolHold, AfterOrbitZoomAndPanelTheToolComesUnderTheCursor) {
    ToolHold hold;
    PictureView view = viewOf(0.5, 0.4, 0.2);
    const auto expectUnder = [&](const PixelPoint& cursor, const char* what) {
        const double depth = view.depthOf(hold.wish().position);
        moveTo(hold, cursor);
        expectAt(view.pixelOf(hold.wish().position), cursor, what);
        EXPECT_NEAR(view.depthOf(hold.wish().position), depth, 1e-9);
    };
    hold.lookAt(view);
    hold.begin(at(view.camera.target_W()), kBurr);
    expectUnder({300, 300}, "held");
    view = viewOf(1.1, 0.2, 0.2);
    hold.lookAt(view);
    hold.handle(MouseMoveEvent{{500, 350}}, true);
    expectUnder({505, 350}, "orbited");
    view = viewOf(1.1, 0.2, 0.1);
    hold.lookAt(view);
    expectUnder({506, 350}, "zoomed");
    hold.passOver({850, 100});
    expectUnder({700, 200}, "back from the panel");
    view.has_places = false;
    hold.lookAt(view);
    const PixelPoint before = view.pixelOf(hold.wish().position);
    moveTo(hold, {710, 190});
    expectAt(view.pixelOf(hold.wish().position), {before.x + 10, before.y - 10}, "in stereo as far");
}

TEST(ToolHold, ButtonsAndKeysMillAndAdd) {
    ToolHold hold;
    press(hold, MouseButton::kLeft);
    EXPECT_EQ(hold.buttons(), 0u) << "it holds no tool";
    hold.begin({}, kBurr);
    EXPECT_EQ(hold.buttons(), 0u);
    press(hold, MouseButton::kLeft);
    EXPECT_EQ(hold.buttons(), uint32_t{kButtonRemove});
    press(hold, MouseButton::kLeft, false);
    EXPECT_EQ(hold.buttons(), 0u);
    press(hold, MouseButton::kLeft, true, {true, false});
    EXPECT_EQ(hold.buttons(), uint32_t{kButtonAdd});
    key(hold, keyOf('B'));
    EXPECT_EQ(hold.buttons(), uint32_t{kButtonRemove}) << "removing goes first";
    press(hold, MouseButton::kLeft, false);
    key(hold, keyOf('B'), false);
    EXPECT_EQ(hold.buttons(), 0u);
    key(hold, keyOf('A'));
    EXPECT_EQ(hold.buttons(), uint32_t{kButtonAdd});
    hold.letGo();
    EXPECT_EQ(hold.buttons(), 0u);
    EXPECT_FALSE(hold.isHolding());
}

TEST(ToolHold, ARightDragTurnsTheToolOnTheSpot) {
    const PictureView view = viewOf(0, 0, 0.2);  // looks along +y, x to the left
    ToolHold hold;
    hold.lookAt(view);
    hold.begin({view.camera.target_W(), Eigen::Quaterniond::Identity()}, kBurr);
    moveTo(hold, {400, 300});
    const Eigen::Vector3d before = hold.wish().position;
    press(hold, MouseButton::kRight);
    moveTo(hold, {460, 300});
    EXPECT_EQ(hold.wish().position, before);
    const Eigen::Vector3d turn_W = logRotation(hold.wish().rotation);
    EXPECT_LT((turn_W - 0.1 * ToolHold::kTurnPerHeight * view.camera.R_WC.col(1)).norm(), 1e-9);
    press(hold, MouseButton::kRight, false);
    key(hold, keyOf('V'));
    moveTo(hold, {400, 300});
    EXPECT_LT(logRotation(hold.wish().rotation).norm(), 1e-9) << "and back, by key";
    EXPECT_EQ(hold.wish().position, before);
    moveTo(hold, {430, 300});
    key(hold, keyOf('V'), false);
    const PixelPoint seen = view.pixelOf(before);
    moveTo(hold, {440, 300});
    expectAt(view.pixelOf(hold.wish().position), {seen.x + 10, seen.y}, "it stays in its hole");
}

TEST(HoldMonitor, AToolThatTheBoneHasCaughtIsFreedAndThenOnlyTheUserCanHelp) {
    using Advice = HoldMonitor::Advice;
    HoldMonitor watch;
    HoldMonitor::Sight sight{.now = 100, .burr_radius = 1e-3, .from_wish = 5e-3};
    const auto adviceWithin = [&](double seconds) {
        for (const double end = sight.now + seconds; sight.now < end; sight.now += 0.02)
            if (const Advice advice = watch.look(sight); advice != Advice::kNone) return advice;
        return Advice::kNone;
    };
    EXPECT_EQ(adviceWithin(10), Advice::kNone) << "it presses on the bone";
    sight.from_wish = 8e-3;
    sight.presses = sight.touches = true;
    EXPECT_EQ(adviceWithin(10), Advice::kNone) << "it mills its way";
    sight.presses = false;
    EXPECT_EQ(adviceWithin(1.9), Advice::kNone);
    sight.from_wish = 1e-3;
    EXPECT_EQ(adviceWithin(0.1), Advice::kNone);
    sight.from_wish = 8e-3;
    EXPECT_EQ(adviceWithin(1.9), Advice::kNone);
    EXPECT_EQ(adviceWithin(0.2), Advice::kFree);
    EXPECT_EQ(adviceWithin(2.1), Advice::kFree);
    EXPECT_EQ(adviceWithin(2.1), Advice::kHelp);
    EXPECT_EQ(adviceWithin(20), Advice::kNone) << "it is said once";
    sight.from_wish = 0;
    EXPECT_EQ(adviceWithin(0.1), Advice::kNone);
    sight.from_wish = 8e-3;
    sight.now += 60;
    EXPECT_EQ(adviceWithin(1.9), Advice::kNone) << "nobody looked meanwhile";
    EXPECT_EQ(adviceWithin(0.2), Advice::kFree);
}

TEST(HoldMonitor, WhoMillsInTheAirIsToldOnceHowToComeNearer) {
    using Advice = HoldMonitor::Advice;
    HoldMonitor watch;
    HoldMonitor::Sight sight{.now = 100, .burr_radius = 1e-3, .presses = true};
    const auto adviceWithin = [&](double seconds) {
        for (const double end = sight.now + seconds; sight.now < end; sight.now += 0.02)
            if (const Advice advice = watch.look(sight); advice != Advice::kNone) return advice;
        return Advice::kNone;
    };
    EXPECT_EQ(adviceWithin(1.5), Advice::kNone);
    sight.touches = true;
    EXPECT_EQ(adviceWithin(0.1), Advice::kNone);
    sight.touches = false;
    EXPECT_EQ(adviceWithin(1.9), Advice::kNone);
    EXPECT_EQ(adviceWithin(0.2), Advice::kTouch);
    EXPECT_EQ(adviceWithin(9), Advice::kNone);
    sight.presses = false;
    EXPECT_EQ(adviceWithin(0.1), Advice::kNone);
    sight.presses = true;
    sight.can_mill = false;
    EXPECT_EQ(adviceWithin(5), Advice::kNone) << "it is paused";
    sight.can_mill = true;
    EXPECT_EQ(adviceWithin(2.1), Advice::kTouch);
}

TEST(ToolHold, BeginsInFrontOfTheSurfaceWithTheHandOnTheUsersSide) {
    std::mt19937 random(4);
    for (int i = 0; i < 50; ++i) {
        const PictureView view = anyView(random);
        const Eigen::Vector3d surface_W = view.pointAt(anyPixel(random), view.camera.focus);
        const Eigen::Vector3d towards_eye = (view.camera.eye_W - surface_W).normalized();
        const auto shaft = [](const Pose& X_WT) { return X_WT.rotation * Eigen::Vector3d::UnitY().eval(); };
        for (const Eigen::Vector3d& was : {towards_eye, Eigen::Vector3d(-towards_eye)}) {
            const Pose X_WT_before{surface_W, rotationBetween(Eigen::Vector3d::UnitY(), was)};
            const Pose X_WT = beginInFrontOf(surface_W, view.camera, kBurr, X_WT_before);
            expectAt(view.pixelOf(X_WT.position), view.pixelOf(surface_W), "on the line of sight");
            const double front = (X_WT.position - surface_W).dot(towards_eye);
            EXPECT_TRUE(front > 2 * kBurr && front < 5 * kBurr) << front;
            EXPECT_GT(shaft(X_WT).dot(towards_eye), 0.5);
        }
        const Pose free = beginInFrontOf(surface_W, view.camera, kBurr, std::nullopt);
        EXPECT_GT(shaft(free).dot(view.camera.R_WC.col(1)), 0.3) << "it does not hide what it mills";
    }
}

class HoldByControls : public testing::Test, protected test::ControlledViewer {
  protected:
    void send(const WindowEvent& event) { controls_.handle(event, kHoldHeight, session_, wishes_); }
    void type(char letter) {
        for (const bool is_down : {true, false}) send(KeyEvent{keyOf(letter), is_down, false, {}});
    }
    void drag(MouseButton button, Modifiers held = {}) {
        send(MouseMoveEvent{{100, 100}});
        send(MouseButtonEvent{button, true, {100, 100}, held, 0});
        send(MouseMoveEvent{{150, 80}});
        send(MouseButtonEvent{button, false, {150, 80}, held, 0});
    }
    void hold() {
        type('G');
        EXPECT_TRUE(wishes_.hold_tool);
        controls_.toolHold().lookAt({camera_.view(), kHoldWidth, kHoldHeight});
        controls_.toolHold().begin(at(camera_.target_W), kBurr);
    }
};

TEST_F(HoldByControls, TheMouseIsTheToolsAndTheMiddleButtonTheCameras) {
    hold();
    const OrbitCamera before = camera_;
    drag(MouseButton::kLeft);
    send(ScrollEvent{1});
    EXPECT_EQ(camera_.azimuth, before.azimuth);
    EXPECT_EQ(camera_.distance, before.distance);
    const Eigen::Vector3d tool = controls_.toolHold().wish().position;
    send(MouseMoveEvent{{100, 100}});
    const Eigen::Vector3d here = controls_.toolHold().wish().position;
    EXPECT_NE(here, tool);
    drag(MouseButton::kMiddle);
    EXPECT_NE(camera_.azimuth, before.azimuth);
    EXPECT_EQ(camera_.target_W, before.target_W);
    EXPECT_EQ(controls_.toolHold().wish().position, here);
    drag(MouseButton::kMiddle, {true, false});
    EXPECT_NE(camera_.target_W, before.target_W);
    const double azimuth = camera_.azimuth;
    send(KeyEvent{Key::kSpace, true, false, {}});
    drag(MouseButton::kLeft);
    EXPECT_NE(camera_.azimuth, azimuth);
    EXPECT_EQ(controls_.toolHold().buttons(), 0u);
}

TEST_F(HoldByControls, LettingGoGivesTheMouseBack) {
    hold();
    type('G');
    EXPECT_FALSE(controls_.toolHold().isHolding());
    EXPECT_TRUE(wishes_.notice);
    const double azimuth = camera_.azimuth;
    drag(MouseButton::kLeft);
    EXPECT_NE(camera_.azimuth, azimuth);
    type('B');
    EXPECT_EQ(controls_.toolHold().buttons(), 0u);
}

TEST_F(HoldByControls, SaysWhyItCannot) {
    const auto refused = [&] {
        wishes_ = {};
        type('G');
        EXPECT_FALSE(wishes_.hold_tool);
        return wishes_.notice ? wishes_.notice->text : "";
    };
    session_.role = topics::Viewer::VIEWER;
    EXPECT_NE(refused().find("--role operator"), std::string::npos);
    session_.role = topics::Viewer::OPERATOR;
    session_.has_server = false;
    EXPECT_EQ(refused(), "There is no server");
    session_.has_server = true;
    topics::Viewer& other = session_.others.emplace_back();
    other.set_name("Ada");
    other.set_is_holding(true);
    EXPECT_EQ(refused(), "Ada holds the tool");
    other.set_is_holding(false);
    status_.mutable_device()->set_name("ARES emulator");
    status_.mutable_device()->set_kind(uint32_t(DeviceKind::kAres));
    EXPECT_NE(refused().find("ARES emulator holds the tool"), std::string::npos);
    status_.mutable_device()->set_kind(uint32_t(DeviceKind::kPointer));
    EXPECT_TRUE(isHeldByMouse(session_));
    type('G');
    EXPECT_TRUE(wishes_.hold_tool);
}

}  // namespace
}  // namespace bonemill
