// Clicks the control panel with a simulated mouse, without OpenGL.
#include "render_client/panel/panel/panel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "common/device_messages/device_messages.h"
#include "tests/unit/render_client/panel/panel/panel_clicks.h"

namespace bonemill {
namespace {

using test::kPanelHeight;
using test::kPanelWidth;
using test::PanelClicks;

// Below it everything still works, and nothing is there without it.
TEST_F(PanelClicks, TrainingTakesItsPlaceOnlyWhereTheSceneTeachesCare) {
    const double before = at("End the session").y;
    status_.mutable_training()->set_damaged_mm3(0.2);
    status_.mutable_training()->add_warnings("damaged facial nerve");
    status_.mutable_training()->add_warnings("bone too hot");
    layOut();
    EXPECT_NEAR(at("End the session").y, before, 1) << "it comes after the session's controls";
    status_.clear_training();
    layOut();
    EXPECT_NEAR(at("End the session").y, before, 1);
}

TEST_F(PanelClicks, TheToolIsOfferedWhereAMouseHoldsIt) {
    layOut();
    EXPECT_FALSE(panel_.find("Hold the tool (G)"));
    status_.mutable_device()->set_kind(uint32_t(DeviceKind::kPointer));
    click("Hold the tool (G)");
    EXPECT_TRUE(wishes_.hold_tool);
    controls_.toolHold().begin({}, 1e-3);
    click("Hold the tool (G)");
    EXPECT_FALSE(controls_.toolHold().isHolding());
    wishes_ = {};
    session_.others.emplace_back().set_is_holding(true);
    click("Hold the tool (G)");
    EXPECT_FALSE(wishes_.hold_tool) << "another viewer has it";
}

TEST_F(PanelClicks, StructuresAreListedWhereTheSceneProtectsSome) {
    layOut();
    EXPECT_FALSE(panel_.find("facial nerve"));
    info_.add_materials()->set_name("cortical bone");
    info_.add_materials()->set_name("facial nerve");
    info_.mutable_materials(1)->set_is_protected(true);
    layOut();
    EXPECT_FALSE(panel_.find("cortical bone"));
    constexpr size_t kNerve = 2;
    click("through bone");
    EXPECT_EQ(settings_.structures[kNerve], StructureMode::kThroughBone);
    click("facial nerve");
    EXPECT_EQ(settings_.structures[kNerve], StructureMode::kOff);
    click("facial nerve");
    EXPECT_EQ(settings_.structures[kNerve], StructureMode::kExposedOnly);
    click("All (Shift+T)");
    EXPECT_EQ(settings_.structures[kNerve], StructureMode::kThroughBone);
    click("Thickness (Shift+D)");
    EXPECT_TRUE(settings_.show_thickness);
    click("Distance line");
    EXPECT_FALSE(settings_.show_clearance);
}

TEST_F(PanelClicks, BoxesSwitchWhatIsSeen) {
    click("Cut Y");
    EXPECT_TRUE(settings_.cuts[1].is_on);
    click("Flip##z");
    EXPECT_TRUE(settings_.cuts[2].is_flipped);
    click("Transparent (T)");
    EXPECT_TRUE(settings_.is_transparent);
    click("Transparent (T)");
    EXPECT_FALSE(settings_.is_transparent);
    click("Endoscope (E)");
    EXPECT_EQ(settings_.camera, CameraMode::kEndoscope);
    click("Microscope (Shift+E)");
    EXPECT_EQ(settings_.camera, CameraMode::kMicroscope);
    click("Depth of field");
    EXPECT_TRUE(settings_.has_depth_of_field);
    click("Depth of field");
    EXPECT_FALSE(settings_.has_depth_of_field);
    click("Microscope (Shift+E)");
    click("Force arrow (F)");
    EXPECT_FALSE(settings_.show_force);
    click("Quick drawing (Q)");
    EXPECT_EQ(settings_.quality, Quality::kQuick);
    click("Quick drawing (Q)");
    EXPECT_EQ(settings_.quality, Quality::kFull);
    click("Figures (Tab)");
    EXPECT_FALSE(settings_.show_hud);
    click("Watchers (W)");
    EXPECT_TRUE(settings_.show_watchers);
    click("All (Shift+Tab)");
    EXPECT_TRUE(settings_.show_details && settings_.show_hud);
    click("Help (H)");
    EXPECT_TRUE(settings_.show_help);
    EXPECT_FALSE(panel_.drawData()) << "the help is in front";
    EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, true, {400, 300}, {}, 0}));
    send(MouseButtonEvent{MouseButton::kLeft, false, {400, 300}, {}, 0});
    EXPECT_FALSE(settings_.show_help) << "a click leads back to the panel";
    click("Red/cyan");
    EXPECT_EQ(settings_.stereo, StereoMode::kAnaglyph);
    click("Off");
    EXPECT_EQ(settings_.stereo, StereoMode::kOff);
    EXPECT_TRUE(wishes_.commands.empty());
}

TEST_F(PanelClicks, SlidersSetHowMuch) {
    const PixelPoint middle = at("##cut x"), opacity = at("##opacity");
    click(PixelPoint{middle.x + 60, middle.y});
    EXPECT_NE(settings_.cuts[0].position, 0.5);
    EXPECT_TRUE(settings_.cuts[0].is_on) << "whoever moves a plane wants to see it";
    click(PixelPoint{kPanelWidth - 30.0, opacity.y});
    EXPECT_GT(settings_.opacity, 0.85);
    EXPECT_TRUE(settings_.is_transparent);
}

TEST_F(PanelClicks, BracketsMoveTheCutThatTheSliderMoved) {
    click("Cut X");
    const PixelPoint middle = at("##cut y");
    click(PixelPoint{middle.x + 60, middle.y});
    const double set = settings_.cuts[1].position;
    controls_.act(Action::kCutHigher, session_, wishes_);
    EXPECT_NEAR(settings_.cuts[1].position, set + 0.02, 1e-9);
    EXPECT_EQ(settings_.cuts[0].position, 0.5);
}

TEST_F(PanelClicks, ACheckpointsTimeMayBeAnything) {
    for (const double seconds : {1e300, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        status_.mutable_checkpoints(0)->set_session_s(seconds);
        layOut();
        EXPECT_TRUE(panel_.find("Back to 3")) << seconds;
    }
}

TEST_F(PanelClicks, ASlidersValueCanBeTyped) {
    const PixelPoint slider = at("##cut z");
    send(MouseMoveEvent{slider});
    send(MouseButtonEvent{MouseButton::kLeft, true, slider, {false, true}, 0});
    send(MouseButtonEvent{MouseButton::kLeft, false, slider, {false, false}, 0});
    layOut();
    // The keys are the panel's now: 2 would be an accuracy.
    EXPECT_TRUE(send(KeyEvent{keyOf('2'), true, false, {}}));
    send(TextEvent{U'2'});
    send(KeyEvent{keyOf('2'), false, false, {}});
    send(TextEvent{U'5'});
    send(KeyEvent{Key::kEnter, true, false, {}});
    send(KeyEvent{Key::kEnter, false, false, {}});
    EXPECT_NEAR(settings_.cuts[2].position, 0.25, 1e-6);
    EXPECT_TRUE(wishes_.commands.empty());
    layOut();
    EXPECT_FALSE(send(KeyEvent{keyOf('T'), true, false, {}})) << "keys are shortcuts again";
}

TEST_F(PanelClicks, ViewButtonsTurnTheCamera) {
    click("Left");
    EXPECT_GT(camera_.towardsEye_W().x(), 0.99);
    click("Top");
    EXPECT_GT(camera_.towardsEye_W().z(), 0.99);
    click("First view (R)");
    EXPECT_TRUE(wishes_.reset_view);
}

TEST_F(PanelClicks, SidesOfAScanThatDoesNotSayHowThePatientLayAreItsAxes) {
    info_.set_lacks_patient_axes(true);
    layOut();
    EXPECT_FALSE(panel_.find("Left"));
    click("+x");
    EXPECT_GT(camera_.towardsEye_W().x(), 0.99);
    click("-y");
    EXPECT_LT(camera_.towardsEye_W().y(), -0.99);
}

TEST_F(PanelClicks, SessionButtonsAreCommands) {
    EXPECT_TRUE(clickForCommand("Pause milling (P)").pause_milling());
    EXPECT_TRUE(clickForCommand("Put the bone back (C)").reset_volume());
    EXPECT_TRUE(clickForCommand("Save a checkpoint (K)").save_checkpoint());
    EXPECT_EQ(clickForCommand("Back to 3").restore_checkpoint(), 3u);
    EXPECT_EQ(clickForCommand("Back to 5").restore_checkpoint(), 5u);
    const topics::Command tool = clickForCommand("3 mm##tool 1");
    EXPECT_EQ(tool.action_case(), topics::Command::kSelectTool);
    EXPECT_EQ(tool.select_tool(), 1u);
    EXPECT_EQ(clickForCommand("exact").set_accuracy(), "exact");
    EXPECT_EQ(clickForCommand("As the scene file says (0)").set_accuracy(), "scene");
}

TEST_F(PanelClicks, AQuestionStandsUntilItIsAnswered) {
    status_.set_removed_mm3(5);
    click("Back to 3");
    EXPECT_TRUE(wishes_.commands.empty());
    session_.time_s += 1000;
    click("Stay (Esc)");
    layOut();
    EXPECT_FALSE(panel_.find("Stay (Esc)"));
    EXPECT_TRUE(wishes_.commands.empty());
    click("Back to 3");
    EXPECT_EQ(clickForCommand("Go back (Enter)").restore_checkpoint(), 3u);
    click("Back to 3");
    EXPECT_EQ(clickForCommand("Back to 3").restore_checkpoint(), 3u) << "the same button once more";
    click("Back to 3");
    wishes_ = {};
    click("Save a checkpoint first");
    EXPECT_EQ(wishes_.commands.size(), 2u);
    layOut();
    EXPECT_FALSE(panel_.find("Go back (Enter)"));
}

TEST_F(PanelClicks, KeysAnswerAQuestionAndNothingElse) {
    const auto press = [this](Key key) {
        wishes_ = {};
        const bool is_panels = send(KeyEvent{key, true, false, {}});
        send(KeyEvent{key, false, false, {}});
        layOut();
        return is_panels;
    };
    switchPanel();
    status_.set_removed_mm3(5);
    controls_.act(Action::kResetBone, session_, wishes_);
    layOut();
    EXPECT_TRUE(panel_.drawData()) << "also while the panel is closed";
    EXPECT_TRUE(press(Key::kEscape));
    EXPECT_TRUE(wishes_.commands.empty() && !wishes_.quit);
    EXPECT_FALSE(panel_.drawData());
    EXPECT_FALSE(press(Key::kEnter)) << "it has been answered";
    controls_.act(Action::kResetBone, session_, wishes_);
    EXPECT_TRUE(press(Key::kEnter));
    EXPECT_EQ(wishes_.commands.size(), 1u);
}

TEST_F(PanelClicks, ADeviceIsResetWhereThereIsOne) {
    layOut();
    EXPECT_FALSE(panel_.find("Reset the device (D)"));
    status_.mutable_device()->set_name("Touch");
    EXPECT_TRUE(clickForCommand("Reset the device (D)").reset_device());
}

TEST_F(PanelClicks, WhatIsInForceAlreadyIsNotAskedForAgain) {
    click("6 mm##tool 0");
    click("balanced");
    EXPECT_TRUE(wishes_.commands.empty());
}

TEST_F(PanelClicks, ItFollowsTheServer) {
    status_.set_is_milling_paused(true);
    const topics::Command go_on = clickForCommand("Pause milling (P)");
    EXPECT_EQ(go_on.action_case(), topics::Command::kPauseMilling);
    EXPECT_FALSE(go_on.pause_milling());
    status_.clear_checkpoints();
    status_.add_checkpoints()->set_id(9);
    info_.set_tool_index(1);
    layOut();
    EXPECT_FALSE(panel_.find("Back to 3"));
    EXPECT_TRUE(panel_.find("Back to 9"));
    EXPECT_EQ(clickForCommand("6 mm##tool 0").select_tool(), 0u);
}

TEST_F(PanelClicks, TheSessionEndsOnlyAfterASecondClick) {
    click("End the session");
    EXPECT_TRUE(wishes_.commands.empty());
    click("Go on");
    EXPECT_FALSE(panel_.find("End"));
    click("End the session");
    EXPECT_TRUE(clickForCommand("End").shut_down());
}

TEST_F(PanelClicks, AViewerClicksCommandsInVain) {
    session_.role = topics::Viewer::VIEWER;
    for (const char* label : {"Pause milling (P)", "Put the bone back (C)", "Save a checkpoint (K)",
                              "Back to 3", "3 mm##tool 1", "exact", "End the session"})
        click(label);
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_FALSE(panel_.find("End"));
    click("Cut X");
    EXPECT_TRUE(settings_.cuts[0].is_on);
}

TEST_F(PanelClicks, AnOperatorCannotEndTheSession) {
    session_.role = topics::Viewer::OPERATOR;
    click("End the session");
    EXPECT_FALSE(panel_.find("End"));
    EXPECT_TRUE(clickForCommand("Put the bone back (C)").reset_volume());
}

TEST_F(PanelClicks, TheMouseBesideThePanelIsNotThePanels) {
    const PixelPoint beside{50, 300};
    EXPECT_FALSE(send(MouseMoveEvent{beside}));
    EXPECT_FALSE(send(MouseButtonEvent{MouseButton::kLeft, true, beside, {}, 0}));
    EXPECT_FALSE(send(MouseMoveEvent{at("Cut X")})) << "a drag that began beside it goes on over it";
    send(MouseButtonEvent{MouseButton::kLeft, false, at("Cut X"), {}, 0});
    EXPECT_FALSE(settings_.cuts[0].is_on);
    EXPECT_TRUE(send(MouseMoveEvent{at("Cut X")}));
    EXPECT_TRUE(send(ScrollEvent{1}));
    send(MouseMoveEvent{beside});
    EXPECT_FALSE(send(ScrollEvent{1}));
}

TEST_F(PanelClicks, AClosedPanelTakesNothing) {
    const PixelPoint place = at("Cut X");
    switchPanel();
    layOut();
    EXPECT_FALSE(panel_.drawData());
    EXPECT_FALSE(panel_.find("Cut X"));
    EXPECT_FALSE(send(MouseMoveEvent{place}));
    EXPECT_FALSE(send(MouseButtonEvent{MouseButton::kLeft, true, place, {}, 0}));
    EXPECT_FALSE(settings_.cuts[0].is_on);
}

TEST_F(PanelClicks, InALowPictureItScrolls) {
    height_ = 300;
    layOut();
    layOut();
    ASSERT_FALSE(panel_.find("exact"));
    send(MouseMoveEvent{at("Cut X")});
    for (int i = 0; i < 60 && !panel_.find("exact"); ++i) {
        send(ScrollEvent{-1});
        layOut();
    }
    EXPECT_EQ(clickForCommand("exact").set_accuracy(), "exact");
}

TEST_F(PanelClicks, ItGrowsWithTheDisplaysScale) {
    const double before = at("Cut Z").y - at("Cut X").y;
    const int version = panel_.fontPixels().version;
    for (int n = 0; n < 2; ++n) ControlledPanel::layOut(2 * kPanelWidth, 2 * kPanelHeight, 2);
    EXPECT_NEAR(panel_.find("Cut Z")->y - panel_.find("Cut X")->y, 2 * before, 3);
    EXPECT_NE(panel_.fontPixels().version, version);
}

}  // namespace
}  // namespace bonemill
