#include "render_client/hand/controls/viewer_controls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/controlled_viewer.h"

namespace bonemill {
namespace {

constexpr int kHeight = 500;

class Controls : public testing::Test, protected test::ControlledViewer {
  protected:
    void type(char letter, bool with_shift = false) {
        send(KeyEvent{keyOf(letter), true, false, {with_shift, false}});
        send(KeyEvent{keyOf(letter), false, false, {with_shift, false}});
    }
    void send(const WindowEvent& event) { controls_.handle(event, kHeight, session_, wishes_); }
    void press(double x, double y, MouseButton button = MouseButton::kLeft, Modifiers held = {},
               double time = 0) {
        send(MouseButtonEvent{button, true, {x, y}, held, time});
    }
    void release(double x, double y, MouseButton button = MouseButton::kLeft) {
        send(MouseButtonEvent{button, false, {x, y}, {}, 0});
    }
    void drag(MouseButton button, Modifiers held = {}) {
        press(100, 100, button, held);
        send(MouseMoveEvent{{150, 80}});
        release(150, 80, button);
    }
};

TEST_F(Controls, KeysSwitchWhatIsSeenAndBack) {
    const auto switches = [this](char key, const bool& value) {
        const bool before = value;
        type(key);
        EXPECT_NE(value, before) << key;
        type(key);
        EXPECT_EQ(value, before) << key;
    };
    switches('F', settings_.show_force);
    switches('T', settings_.is_transparent);
    switches('W', settings_.show_watchers);
    switches('H', settings_.show_help);
    switches('X', settings_.cuts[0].is_on);
    switches('Y', settings_.cuts[1].is_on);
    switches('Z', settings_.cuts[2].is_on);
    send(KeyEvent{Key::kTab, true, false, {}});
    EXPECT_FALSE(settings_.show_hud);
    send(KeyEvent{Key::kTab, true, false, {true, false}});
    EXPECT_TRUE(settings_.show_hud && settings_.show_details) << "who asks for all wants to see them";
    type('W');
    EXPECT_TRUE(settings_.show_watchers && !settings_.show_details) << "one list at a time";
    send(KeyEvent{Key::kTab, true, false, {true, false}});
    EXPECT_TRUE(settings_.show_details && !settings_.show_watchers);
    send(KeyEvent{Key::kTab, true, false, {true, false}});
    EXPECT_TRUE(settings_.show_hud);
    EXPECT_FALSE(settings_.show_details);
    EXPECT_FALSE(controls_.isPanelOpen());
    type('M');
    EXPECT_TRUE(controls_.isPanelOpen());
    EXPECT_TRUE(wishes_.commands.empty());
}

TEST_F(Controls, AKeyMakesTextLargerWithinBounds) {
    type('J');
    EXPECT_GT(settings_.text_scale, 1.2);
    type('J', true);
    EXPECT_NEAR(settings_.text_scale, 1, 1e-12);
    for (int i = 0; i < 50; ++i) type('J');
    EXPECT_EQ(settings_.text_scale, ViewSettings::kMaxText);
    for (int i = 0; i < 50; ++i) type('J', true);
    EXPECT_EQ(settings_.text_scale, ViewSettings::kMinText);
}

TEST_F(Controls, StereoGoesRoundThreeModes) {
    type('S');
    EXPECT_EQ(settings_.stereo, StereoMode::kSideBySide);
    type('S');
    EXPECT_EQ(settings_.stereo, StereoMode::kAnaglyph);
    type('S');
    EXPECT_EQ(settings_.stereo, StereoMode::kOff);
    type('E');
    EXPECT_EQ(settings_.camera, CameraMode::kEndoscope);
    type('E');
    EXPECT_EQ(settings_.camera, CameraMode::kOrbit);
}

TEST_F(Controls, OneCameraTakesTheOthersPlace) {
    type('E');
    type('E', true);
    EXPECT_EQ(settings_.camera, CameraMode::kMicroscope);
    type('E');
    EXPECT_EQ(settings_.camera, CameraMode::kEndoscope);
    type('E', true);
    type('E', true);
    EXPECT_EQ(settings_.camera, CameraMode::kOrbit);
}

TEST_F(Controls, StructuresGoRoundThreeModesAndEachHasItsOwn) {
    constexpr size_t kNerve = 3;
    controls_.showStructure(kNerve, StructureMode::kOff);
    EXPECT_EQ(settings_.structures[kNerve], StructureMode::kOff);
    EXPECT_EQ(settings_.structures[kNerve + 1], StructureMode::kExposedOnly);
    for (const StructureMode mode :
         {StructureMode::kThroughBone, StructureMode::kOff, StructureMode::kExposedOnly}) {
        type('T', true);
        for (const StructureMode shown : settings_.structures) EXPECT_EQ(shown, mode);
    }
    EXPECT_FALSE(settings_.is_transparent);
    type('D', true);
    EXPECT_TRUE(settings_.show_thickness);
    type('D', true);
    EXPECT_FALSE(settings_.show_thickness);
    EXPECT_TRUE(wishes_.commands.empty());
}

TEST_F(Controls, TheMouseHoversWhileItDragsNothing) {
    send(MouseMoveEvent{{120, 90}});
    ASSERT_TRUE(controls_.hovering());
    EXPECT_EQ(controls_.hovering()->x, 120);
    press(120, 90);
    EXPECT_FALSE(controls_.hovering());
    release(120, 90);
    EXPECT_TRUE(controls_.hovering());
    controls_.toolHold().begin({}, 1e-3);
    send(MouseMoveEvent{{150, 80}});
    ASSERT_TRUE(controls_.hovering()) << "structures have names for who holds the tool, too";
    EXPECT_EQ(controls_.hovering()->x, 150);
    press(150, 80);
    EXPECT_FALSE(controls_.hovering()) << "it mills";
}

TEST_F(Controls, BracketsMoveTheCutThatWasSwitchedLastWithinTheBone) {
    type('X');
    type('Z');
    send(TextEvent{U']'});
    EXPECT_GT(settings_.cuts[2].position, 0.5);
    EXPECT_EQ(settings_.cuts[0].position, 0.5);
    type('Y', true);
    EXPECT_TRUE(settings_.cuts[1].is_flipped);
    for (int i = 0; i < 100; ++i) send(TextEvent{U'['});
    EXPECT_EQ(settings_.cuts[1].position, 0);
    for (int i = 0; i < 100; ++i) send(TextEvent{U']'});
    EXPECT_EQ(settings_.cuts[1].position, 1);
}

TEST_F(Controls, BracketsMoveTheCutThatWasPlacedLast) {
    type('X');
    controls_.moveCutTo(1, 0.3);
    EXPECT_TRUE(settings_.cuts[1].is_on) << "whoever moves a plane wants to see it";
    send(TextEvent{U']'});
    EXPECT_NEAR(settings_.cuts[1].position, 0.32, 1e-12);
    EXPECT_EQ(settings_.cuts[0].position, 0.5);
    controls_.moveCutTo(1, 7);
    EXPECT_EQ(settings_.cuts[1].position, 1);
}

TEST_F(Controls, TheRestOfTheViewIsSetWithinBounds) {
    controls_.setStereo(StereoMode::kAnaglyph);
    EXPECT_EQ(settings_.stereo, StereoMode::kAnaglyph);
    controls_.setOpacity(1.5);
    EXPECT_EQ(settings_.opacity, 1);
    EXPECT_TRUE(settings_.is_transparent);
    type('Q');
    EXPECT_EQ(settings_.quality, Quality::kQuick);
    type('Q');
    EXPECT_EQ(settings_.quality, Quality::kFull);
}

TEST_F(Controls, DragsOrbitAndPan) {
    const OrbitCamera before = camera_;
    drag(MouseButton::kLeft);
    EXPECT_LT(camera_.azimuth, before.azimuth) << "the bone follows the mouse to the right";
    EXPECT_LT(camera_.elevation, before.elevation) << "and upwards";
    EXPECT_EQ(camera_.target_W, before.target_W);

    for (const auto& [button, held] :
         {std::pair{MouseButton::kRight, Modifiers{}}, std::pair{MouseButton::kMiddle, Modifiers{}},
          std::pair{MouseButton::kLeft, Modifiers{true, false}}}) {
        camera_ = before;
        drag(button, held);
        EXPECT_EQ(camera_.azimuth, before.azimuth);
        EXPECT_NE(camera_.target_W, before.target_W);
    }
}

TEST_F(Controls, AMoveWithoutAButtonChangesNothing) {
    const OrbitCamera before = camera_;
    send(MouseMoveEvent{{10, 10}});
    send(MouseMoveEvent{{300, 10}});
    EXPECT_EQ(camera_.azimuth, before.azimuth);
    press(300, 10);
    release(300, 10);
    send(MouseMoveEvent{{10, 10}});
    EXPECT_EQ(camera_.azimuth, before.azimuth);
}

TEST_F(Controls, WheelAndSignsZoomArrowsOrbit) {
    const OrbitCamera before = camera_;
    send(ScrollEvent{1});
    EXPECT_LT(camera_.distance, before.distance);
    send(TextEvent{U'-'});
    EXPECT_NEAR(camera_.distance, before.distance, 1e-12);
    send(TextEvent{U'+'});
    EXPECT_LT(camera_.distance, before.distance);
    send(KeyEvent{Key::kRight, true, false, {}});
    send(KeyEvent{Key::kRight, true, true, {}});
    const double turned = before.azimuth - camera_.azimuth;
    EXPECT_NEAR(turned, 10 * M_PI / 180, 1e-3);
    send(KeyEvent{Key::kUp, true, false, {}});
    EXPECT_LT(camera_.elevation, before.elevation);
}

TEST_F(Controls, TwoQuickClicksAtOnePlaceCentreTheOrbit) {
    press(200, 100, MouseButton::kLeft, {}, 1.0);
    release(200, 100);
    EXPECT_FALSE(wishes_.centre_at);
    press(202, 101, MouseButton::kLeft, {}, 1.2);
    release(202, 101);
    ASSERT_TRUE(wishes_.centre_at);
    EXPECT_EQ(wishes_.centre_at->x, 202);
}

TEST_F(Controls, SlowOrDistantClicksDoNot) {
    press(200, 100, MouseButton::kLeft, {}, 1.0);
    release(200, 100);
    press(200, 100, MouseButton::kLeft, {}, 2.0);
    release(200, 100);
    press(260, 100, MouseButton::kLeft, {}, 2.1);
    release(260, 100);
    EXPECT_FALSE(wishes_.centre_at);
}

TEST_F(Controls, AnInstructorPointsWhileLOrControlDragIsHeld) {
    session_.role = topics::Viewer::INSTRUCTOR;
    send(MouseMoveEvent{{40, 50}});
    EXPECT_FALSE(controls_.pointing());
    send(KeyEvent{keyOf('L'), true, false, {}});
    ASSERT_TRUE(controls_.pointing());
    EXPECT_EQ(controls_.pointing()->y, 50);
    send(KeyEvent{keyOf('L'), false, false, {}});
    EXPECT_FALSE(controls_.pointing());

    const double azimuth = camera_.azimuth;
    press(60, 70, MouseButton::kLeft, {false, true});
    send(MouseMoveEvent{{90, 70}});
    ASSERT_TRUE(controls_.pointing());
    EXPECT_EQ(controls_.pointing()->x, 90);
    release(90, 70);
    EXPECT_FALSE(controls_.pointing());
    EXPECT_EQ(camera_.azimuth, azimuth);
    EXPECT_FALSE(wishes_.notice);
}

TEST_F(Controls, OthersAreToldWhyTheyCannotPoint) {
    send(KeyEvent{keyOf('L'), true, false, {}});
    EXPECT_FALSE(controls_.pointing());
    ASSERT_TRUE(wishes_.notice);
    EXPECT_NE(wishes_.notice->text.find("--role instructor"), std::string::npos);
    wishes_ = {};
    press(60, 70, MouseButton::kLeft, {false, true});
    EXPECT_FALSE(controls_.pointing());
    EXPECT_TRUE(wishes_.notice);
}

TEST_F(Controls, InStereoNoPlaceCanBeMeant) {
    session_.role = topics::Viewer::INSTRUCTOR;
    settings_.stereo = StereoMode::kAnaglyph;
    send(KeyEvent{keyOf('L'), true, false, {}});
    EXPECT_FALSE(controls_.pointing());
    EXPECT_TRUE(wishes_.notice);
    wishes_ = {};
    for (int i = 0; i < 2; ++i) {
        press(200, 100);
        release(200, 100);
    }
    EXPECT_FALSE(wishes_.centre_at);
    EXPECT_TRUE(wishes_.notice);
}

TEST_F(Controls, CommandsAreWishesAndRefusalsNotices) {
    type('C');
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_TRUE(wishes_.commands[0].reset_volume());
    type('3');
    ASSERT_EQ(wishes_.commands.size(), 2u);
    EXPECT_EQ(wishes_.commands[1].set_accuracy(), "balanced");
    EXPECT_FALSE(wishes_.notice);
    session_.role = topics::Viewer::VIEWER;
    type('C');
    EXPECT_EQ(wishes_.commands.size(), 2u);
    EXPECT_TRUE(wishes_.notice);
}

TEST_F(Controls, AfterAScriptKeysBeginAgainAndTakeOver) {
    topics::Status status;
    session_.status = &status;
    type('C', true);
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_TRUE(wishes_.notice);
    status.mutable_device()->set_name("ARES emulator");
    status.mutable_device()->mutable_script()->set_has_ended(true);
    type('C', true);
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_TRUE(wishes_.commands[0].begin_again());
    type('G');
    ASSERT_EQ(wishes_.commands.size(), 2u);
    EXPECT_TRUE(wishes_.commands[1].take_over());
    EXPECT_FALSE(wishes_.hold_tool) << "the tool comes when the mouse is the hand";
    session_.role = topics::Viewer::EXAMINER;
    type('G');
    EXPECT_EQ(wishes_.commands.size(), 2u);
}

TEST_F(Controls, TheRestIsForTheOwner) {
    type('R');
    EXPECT_TRUE(wishes_.reset_view);
    send(KeyEvent{Key::kF12, true, false, {}});
    EXPECT_TRUE(wishes_.save_picture);
    send(KeyEvent{Key::kF11, true, false, {}});
    EXPECT_TRUE(wishes_.full_screen);
    EXPECT_FALSE(wishes_.quit);
    send(KeyEvent{Key::kEscape, true, false, {}});
    send(KeyEvent{Key::kEscape, true, false, {}});
    EXPECT_TRUE(wishes_.quit);
}

TEST_F(Controls, SidesAreThePatientsWhateverIsUp) {
    struct Case {
        Side side;
        Eigen::Vector3d towards_eye;
    };
    const Case cases[] = {{Side::kFront, {0, -1, 0}}, {Side::kBack, {0, 1, 0}}, {Side::kLeft, {1, 0, 0}},
                          {Side::kRight, {-1, 0, 0}}, {Side::kTop, {0, 0, 1}},  {Side::kBottom, {0, 0, -1}}};
    for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, -1, 0),
                                      Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.3, -0.5, 0.8)}) {
        camera_.setUp(up);
        for (const Case& c : cases) {
            controls_.lookFrom(c.side);
            // At the poles the camera stays one degree off.
            EXPECT_GT(camera_.towardsEye_W().dot(c.towards_eye), std::cos(1.05 * M_PI / 180))
                << up.transpose() << ": " << c.towards_eye.transpose();
        }
    }
}

}  // namespace
}  // namespace bonemill
