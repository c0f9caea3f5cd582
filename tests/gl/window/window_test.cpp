// Runs the viewer's real window on a display in memory, with keys and mouse of xdotool and a real publisher
// behind it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>
#include <utility>

#include "render_client/hand/window/glfw_window.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/look/hud/hud_canvas.h"
#include "tests/gl/golden.h"
#include "tests/gl/window/shown_session.h"
#include "tests/gl/window/virtual_display.h"
#include "tests/gl/window/windowed_viewer.h"
#include "tests/support/class_lesson.h"
#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using test::kHeight;
using test::kWidth;
using test::VirtualDisplay;
using test::WindowedViewer;
using Viewer = topics::Viewer;

constexpr double kClearChange = 0.01, kNoChange = 0.002;  // of the picture: another view changes more
constexpr double kSmallChange = 0.1;                      // shadows and smooth edges

double differentShare(const Picture& a, const Picture& b) {
    return test::compare(a, b).bad_part;
}

void expectGolden(const Picture& picture, const std::string& name) {
    EXPECT_EQ(test::goldenProblem(picture, "window_" + name), "");
}

std::string number(double value) {
    return std::to_string(int(value));
}

class Window : public testing::Test {
  protected:
    Window() : observer_({.domain = testDomain(), .session = testSession(), .name = "observer"}) {
        test::useSoftwareRenderer();
    }

    // Waits for what has to come: never for a time.
    void waitFor(const std::string& what, const std::function<bool()>& holds) {
        const auto end = std::chrono::steady_clock::now() + 60s;
        while (!holds()) {
            if (std::chrono::steady_clock::now() > end) {
                for (auto& viewer : viewers_) ADD_FAILURE() << viewer->process().errSoFar();
                throw std::runtime_error("waited in vain for: " + what);
            }
            std::this_thread::sleep_for(10ms);
        }
    }
    std::optional<Viewer> heard(const std::string& name) {
        observer_.poll();
        for (const Viewer& viewer : observer_.viewers())
            if (viewer.name() == name) return viewer;
        return std::nullopt;
    }
    // Shows the whole model when this returns.
    WindowedViewer& start(const std::string& name, const std::string& role, const std::string& more = "") {
        viewers_.push_back(std::make_unique<WindowedViewer>(name, role, more));
        waitFor(name + " to show the model", [&] {
            if (!viewers_.back()->process().isRunning())
                throw std::runtime_error(name + " has ended: " + viewers_.back()->process().errSoFar());
            const auto viewer = heard(name);
            return viewer && viewer->is_complete();
        });
        return *viewers_.back();
    }
    void key(const std::string& name) { display_.type({"key", name}); }
    void moveTo(const PixelPoint& place) { display_.type({"mousemove", number(place.x), number(place.y)}); }
    void drag(const std::string& button, const PixelPoint& by) {
        moveTo({200, 200});
        display_.type(
            {"mousedown", button, "mousemove_relative", "--", number(by.x), number(by.y), "mouseup", button});
    }
    // Returns what the window shows after all that was typed before: events come in their order.
    Picture look(WindowedViewer& viewer) {
        const size_t count = viewer.countPicture();
        key("F12");
        waitFor("F12's picture", [&] { return viewer.picture(count).has_value(); });
        return test::readPng(*viewer.picture(count));
    }
    topics::Command waitForCommand(size_t count) {
        waitFor("command " + std::to_string(count), [&] { return session_.commands().size() >= count; });
        EXPECT_EQ(session_.commands().size(), count);
        return session_.commands().back();
    }
    void waitForLog(WindowedViewer& viewer, const std::string& text) {
        waitFor("'" + text + "' in the log",
                [&] { return viewer.process().errSoFar().find(text) != std::string::npos; });
    }

    VirtualDisplay display_{kWidth, kHeight};
    test::ShownSession session_;
    SceneSubscriber observer_;
    std::vector<std::unique_ptr<WindowedViewer>> viewers_;
};

// Knows where the controls of the viewer's panel are: a panel of its own with the same state.
class PanelTwin : test::ControlledPanel {
  public:
    PanelTwin(const VirtualDisplay& display, test::ShownSession& shown, Viewer::Role role)
        : display_(display), shown_(shown) {
        session_.role = role;
        session_.tool = &tool_;  // the panel's last part shows it
        switchPanel();
        lookAtSession();
    }

    // Scrolls both panels until the control can be seen, and clicks it in both.
    void click(const std::string& label) {
        lookAtSession();
        rest();
        for (int i = 0; i < 40 && !panel_.find(label); ++i) {
            display_.type({"click", "5"});
            sendAndLayOut(ScrollEvent{-1});
        }
        const auto place = panel_.find(label);
        if (!place) throw std::runtime_error("the panel has no control '" + label + "'");
        const PixelPoint pixel{std::floor(place->x), std::floor(place->y)};
        display_.type({"mousemove", number(pixel.x), number(pixel.y), "click", "1"});
        sendAndLayOut(MouseMoveEvent{pixel});
        for (const bool is_down : {true, false})
            sendAndLayOut(MouseButtonEvent{MouseButton::kLeft, is_down, pixel, {}, 0});
        rest();
    }
    // The mouse stands on the panel, where it touches no control.
    void rest() {
        constexpr PixelPoint kTitle{kWidth - 40, 18};
        display_.type({"mousemove", number(kTitle.x), number(kTitle.y)});
        sendAndLayOut(MouseMoveEvent{kTitle});
    }

  private:
    void sendAndLayOut(const WindowEvent& event) {
        send(event);
        layOut(kWidth, kHeight, textScale(kWidth, kHeight));
    }
    void lookAtSession() {
        info_ = shown_.info();
        status_ = shown_.status();
        layOut(kWidth, kHeight, textScale(kWidth, kHeight));
    }

    const VirtualDisplay& display_;
    test::ShownSession& shown_;
    const topics::ToolState tool_;
};

TEST_F(Window, IsNoLargerThanTheScreenHasRoomFor) {
    for (const auto& [width, height] : {std::pair{4 * kWidth, 2 * kHeight}, {kWidth / 2, kHeight / 2}}) {
        const GlfwWindow window(width, height, "sized", "");
        EXPECT_EQ(window.pixelWidth(), std::min(width, kWidth));
        EXPECT_EQ(window.pixelHeight(), std::min(height, kHeight));
    }
}

TEST_F(Window, WhatIsCopiedIsOnTheDisplaysClipboard) {
    session_.tune();
    start("me", "instructor");
    key("m");
    PanelTwin panel(display_, session_, Viewer::INSTRUCTOR);
    for (const char* label : {"Tuning", "Copy"}) panel.click(label);
    const std::string text = "coupling { damping_time_ms: 1.5 }\naccuracy { preset: BALANCED }";
    waitFor("the scene text on the clipboard", [&] { return display_.clipboard() == text; });
}

TEST_F(Window, EveryModeByKeyLooksAsItDid) {
    WindowedViewer& viewer = start("me", "operator");
    key("Tab");  // the figures change
    moveTo({5, 5});
    const Picture plain = look(viewer);
    expectGolden(plain, "plain");
    const auto switchOn = [&](const std::string& key_name, const std::string& picture) {
        key(key_name);
        const Picture shown = look(viewer);
        expectGolden(shown, picture);
        EXPECT_GT(differentShare(shown, plain), kClearChange) << picture;
    };
    key("f");
    EXPECT_GT(differentShare(look(viewer), plain), kNoChange) << "the force arrow is gone";
    key("f");
    switchOn("x", "cut_x");
    switchOn("shift+x", "cut_x_flipped");
    display_.type({"key", "bracketright", "bracketright", "bracketright", "bracketright", "bracketright"});
    expectGolden(look(viewer), "cut_x_moved");
    key("x");
    switchOn("y", "cut_y");
    switchOn("z", "cut_yz");
    display_.type({"key", "y", "z"});
    switchOn("t", "transparent");
    key("t");
    switchOn("s", "side_by_side");
    switchOn("s", "anaglyph");
    key("s");
    switchOn("e", "endoscope");
    key("e");
    switchOn("m", "panel_after_keys");  // it shows what they left
    key("m");
    EXPECT_LT(differentShare(look(viewer), plain), kNoChange) << "everything is switched off again";
    key("Escape");
    waitForLog(viewer, "Close this viewer?");
    key("Return");
    EXPECT_EQ(viewer.process().wait(30s).exit_code, 0);
}

TEST_F(Window, MouseAndKeysMoveTheCamera) {
    WindowedViewer& viewer = start("me", "operator");
    key("Tab");
    const Picture first = look(viewer);
    const auto expectChangeAndReset = [&](const char* what) {
        EXPECT_GT(differentShare(look(viewer), first), kClearChange) << what;
        key("r");
        EXPECT_LT(differentShare(look(viewer), first), kNoChange) << what << ", then R";
    };
    drag("1", {80, 40});
    expectChangeAndReset("left drag");
    drag("3", {80, 0});
    expectChangeAndReset("right drag");
    display_.type({"click", "4", "click", "4", "click", "4"});
    expectChangeAndReset("wheel");
    display_.type({"key", "plus", "plus", "plus"});
    expectChangeAndReset("+");
    display_.type({"key", "Left", "Left", "Up", "Up"});
    expectChangeAndReset("arrows");
    display_.type({"mousemove", "200", "230", "click", "--repeat", "2", "--delay", "30", "1"});
    expectChangeAndReset("double click");
    display_.type({"key", "h", "Tab"});
    EXPECT_GT(differentShare(look(viewer), first), kClearChange) << "help over the picture";
}

TEST_F(Window, CommandsByKeyArrive) {
    WindowedViewer& viewer = start("me", "operator");
    key("c");
    waitForLog(viewer, "Put the bone back? 12.3 mm\u00b3 are milled and in no checkpoint");
    EXPECT_TRUE(session_.commands().empty());
    key("c");
    EXPECT_TRUE(waitForCommand(1).reset_volume());
    EXPECT_EQ(session_.commands()[0].role(), Viewer::OPERATOR);
    key("u");
    waitForLog(viewer, "there is no checkpoint yet");
    key("k");
    EXPECT_TRUE(waitForCommand(2).save_checkpoint());
    waitForLog(viewer, "A checkpoint is saved");
    key("u");
    EXPECT_EQ(waitForCommand(3).restore_checkpoint(), 1u);
    key("n");
    EXPECT_EQ(waitForCommand(4).select_tool(), 1u);
    key("p");
    EXPECT_TRUE(waitForCommand(5).pause_milling());
    waitForLog(viewer, "Milling pauses");
    key("p");
    const topics::Command go_on = waitForCommand(6);
    EXPECT_TRUE(go_on.has_pause_milling() && !go_on.pause_milling());
    const char* presets[] = {"scene", "thesis_2012", "fast", "balanced", "exact"};
    for (size_t digit = 0; digit < 5; ++digit) {
        key(std::to_string(digit));
        EXPECT_EQ(waitForCommand(7 + digit).set_accuracy(), presets[digit]);
    }
    viewer.process().signal(SIGTERM);
    EXPECT_EQ(viewer.process().wait(30s).exit_code, 0);
}

TEST_F(Window, ThePanelWorksByMouse) {
    WindowedViewer& viewer = start("me", "instructor");
    key("Tab");
    const Picture plain = look(viewer);
    key("m");
    PanelTwin panel(display_, session_, Viewer::INSTRUCTOR);
    panel.rest();
    expectGolden(look(viewer), "panel");
    panel.click("Cut X");
    panel.click("Transparent (T)");
    expectGolden(look(viewer), "panel_cut_transparent");
    panel.click("Cut X");
    panel.click("Transparent (T)");
    panel.click("Left");
    expectGolden(look(viewer), "panel_left");
    panel.click("First view (R)");
    panel.click("Quick drawing (Q)");
    expectGolden(look(viewer), "panel_quick");
    key("m");
    EXPECT_LT(differentShare(look(viewer), plain), kSmallChange) << "nothing of the panel is left";
    key("m");

    panel.click("Pause milling (P)");
    EXPECT_TRUE(waitForCommand(1).pause_milling());
    panel.click("Put the bone back (C)");
    waitForLog(viewer, "Put the bone back? 12.3 mm\u00b3 are milled and in no checkpoint");
    panel.click("Put the bone back (C)");
    EXPECT_TRUE(waitForCommand(2).reset_volume());
    panel.click("Save a checkpoint (K)");
    EXPECT_TRUE(waitForCommand(3).save_checkpoint());
    waitForLog(viewer, "A checkpoint is saved");
    panel.click("Back to 1");
    EXPECT_EQ(waitForCommand(4).restore_checkpoint(), 1u);
    panel.click("3 mm##tool 1");
    EXPECT_EQ(waitForCommand(5).select_tool(), 1u);
    panel.click("exact");
    EXPECT_EQ(waitForCommand(6).set_accuracy(), "exact");
    panel.click("End the session");
    panel.click("End");
    EXPECT_TRUE(waitForCommand(7).shut_down());
    EXPECT_EQ(session_.commands().back().role(), Viewer::INSTRUCTOR);
}

// The bone fills the middle, and nothing lies over it.
TEST_F(Window, ThePictureOfAnAttemptLiesBesideItsResult) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "results");
    topics::Lesson lesson = test::makeLesson();
    lesson.set_is_running(true);
    session_.teach(lesson);
    WindowedViewer& viewer = start("teacher", "operator", "--class-folder " + folder.path().string());
    viewer.expectPicturesIn(folder.path() / "pictures");
    const Picture before = look(viewer);
    lesson.set_is_running(false);
    topics::Attempt& attempt = *lesson.add_attempts();
    attempt.set_number(3);
    attempt.mutable_verdict()->set_results("20261120T100000Z_P08_3");
    session_.teach(lesson);
    const std::filesystem::path file = folder / "results/20261120T100000Z_P08_3.png";
    waitFor(file, [&] { return std::filesystem::exists(file); });
    EXPECT_EQ(std::filesystem::status(file).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    const Picture picture = test::readPng(file);
    EXPECT_EQ(picture.width(), 320);
    EXPECT_EQ(picture.height(), 240);
    expectGolden(picture, "attempt");
    EXPECT_EQ(look(viewer).width(), before.width());
}

TEST_F(Window, AViewerOnlyLooks) {
    WindowedViewer& viewer = start("pupil", "viewer");
    key("c");
    waitForLog(viewer, "A viewer only looks: start with --role operator");
    moveTo({200, 200});
    key("l");
    waitForLog(viewer, "Only an instructor points: start with --role instructor");
    look(viewer);
    EXPECT_FALSE(heard("pupil")->pointer_m_size());
    EXPECT_TRUE(session_.commands().empty());
}

TEST_F(Window, ViewersSeeEachOtherAndTheInstructorPointsAndDraws) {
    WindowedViewer& pupil = start("pupil", "viewer");
    WindowedViewer& teacher = start("teacher", "instructor");
    waitForLog(pupil, "teacher (instructor) is watching");
    waitForLog(teacher, "pupil (viewer) is watching");
    waitFor("frame rates",
            [&] { return heard("pupil")->frame_rate_hz() > 0 && heard("teacher")->frame_rate_hz() > 0; });

    const auto pointer = [&]() -> std::optional<Eigen::Vector3d> {
        const auto viewer = heard("teacher");
        if (!viewer || viewer->pointer_m_size() != 3) return std::nullopt;
        return Eigen::Vector3d(viewer->pointer_m().data());
    };
    const auto expectOnTheBody = [&](const char* how) {
        waitFor(how, [&] { return pointer().has_value(); });
        const double from_center = (*pointer() - test::kBlockCenter).norm();
        EXPECT_LT(from_center, 1.02 * test::kBlockRadius) << how;
    };
    moveTo({240, 150});
    display_.type({"keydown", "l"});
    expectOnTheBody("L held");
    display_.type({"keyup", "l"});
    waitFor("no pointer", [&] { return !pointer(); });
    display_.type({"keydown", "ctrl", "mousemove", "250", "150", "mousedown", "1"});
    expectOnTheBody("Ctrl and left drag");
    display_.type({"mouseup", "1", "keyup", "ctrl"});
    waitFor("no pointer", [&] { return !pointer(); });

    display_.type({"keydown", "ctrl", "keydown", "shift", "mousemove", "230", "100", "mousedown", "1",
                   "mousemove", "270", "110", "mouseup", "1", "keyup", "shift", "keyup", "ctrl"});
    const topics::Remark stroke = waitForCommand(1).add_remark();
    EXPECT_EQ(stroke.color(), colourOfAuthor("teacher"));
    ASSERT_GE(stroke.points_m_size(), 6);
    for (int n = 0; n < stroke.points_m_size(); n += 3) {
        const Eigen::Vector3d p_W(stroke.points_m(n), stroke.points_m(n + 1), stroke.points_m(n + 2));
        EXPECT_LT((p_W - test::kBlockCenter).norm(), 1.02 * test::kBlockRadius);
    }

    teacher.process().signal(SIGTERM);
    waitForLog(pupil, "teacher is no longer watching");
}

}  // namespace
}  // namespace bonemill
