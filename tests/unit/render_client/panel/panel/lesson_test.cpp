// Clicks through a class: scenes, trainees, attempts and their summary, without OpenGL.
#include <gtest/gtest.h>

#include "tests/support/class_lesson.h"
#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class LessonClicks : public testing::Test, protected test::ControlledPanel {
  protected:
    LessonClicks() {
        session_.lesson = &lesson_;
        layOut();
    }
    void layOut() { ControlledPanel::layOut(1280, 1000); }
    bool isThere(const std::string& label) {
        layOut();
        return panel_.find(label).has_value();
    }
    void click(const std::string& label) {
        layOut();
        clickAt(label);
        layOut();
    }
    topics::Command command() const {
        return wishes_.commands.empty() ? topics::Command() : wishes_.commands.back();
    }
    void type(const std::string& text) {
        for (const char sign : text) send(TextEvent{char32_t(sign)});
    }
    void press(Key key, Modifiers held = {}) {
        send(KeyEvent{key, true, false, held});
        send(KeyEvent{key, false, false, {}});
    }

    topics::Lesson lesson_ = test::makeLesson();
};

TEST_F(LessonClicks, TheMouseAloneOpensThePanelAndChooses) {
    click("Lesson (M)");
    EXPECT_TRUE(controls_.isPanelOpen());
    click("Pedicle of a vertebra");
    EXPECT_EQ(command().choose_scene(), "pedicle");
    click("Cavity in a molar");
    EXPECT_TRUE(wishes_.commands.empty()) << "it is the scene in force";
    click("Mastoid");
    EXPECT_TRUE(wishes_.commands.empty()) << "it has a problem";
}

TEST_F(LessonClicks, ASceneWhoseBoneIsMadeFirstTakesOneClick) {
    lesson_.mutable_scenes(1)->set_is_made_first(true);
    switchPanel();
    click("Pedicle of a vertebra");
    EXPECT_EQ(command().choose_scene(), "pedicle");
}

TEST_F(LessonClicks, ARowIsClickedAnywhereAndOnlyByAWholeClick) {
    switchPanel();
    layOut();
    const PixelPoint row = panel_.find("Pedicle of a vertebra").value();
    const PixelPoint end{row.x + 250, row.y + 10}, other = panel_.find("Cavity in a molar").value();
    const auto pressAndRelease = [&](const PixelPoint& from) {
        wishes_ = {};
        send(MouseMoveEvent{from});
        send(MouseButtonEvent{MouseButton::kLeft, true, from, {}, 0});
        send(MouseMoveEvent{end});
        send(MouseButtonEvent{MouseButton::kLeft, false, end, {}, 0});
        return command().choose_scene();
    };
    EXPECT_EQ(pressAndRelease(other), "");
    EXPECT_EQ(pressAndRelease(end), "pedicle");
}

TEST_F(LessonClicks, AnAttemptOfTheTableShowsItsCardAgain) {
    switchPanel();
    click("Attempt 1");
    EXPECT_TRUE(isThere("Close"));
    EXPECT_LT(panel_.find("Attempt 2")->y, panel_.find("Attempt 1")->y) << "the newest first";
    EXPECT_LT(panel_.find("Attempt 1")->y, panel_.find("Cavity in a molar")->y);
    click("Close");
    EXPECT_FALSE(isThere("Close"));
}

TEST_F(LessonClicks, InANewSceneThePanelIsAtItsTop) {
    switchPanel();
    ControlledPanel::layOut(1280, 300);
    send(MouseMoveEvent{panel_.find("Start").value()});
    for (int n = 0; n < 10; ++n) send(ScrollEvent{-1});
    ControlledPanel::layOut(1280, 300);
    ASSERT_FALSE(panel_.find("Start"));
    lesson_.set_scene_id("pedicle");
    for (int n = 0; n < 3; ++n) ControlledPanel::layOut(1280, 300);
    EXPECT_TRUE(panel_.find("Start"));
}

TEST_F(LessonClicks, TheButtonStaysWhereItIsBesideSlices) {
    layOut();
    const PixelPoint before = panel_.find("Lesson (M)").value();
    for (int n = 0; n < 3; ++n) {
        panel_.setPicture(1280, 1000, 800, 1, 0.02);
        panel_.layOut(controls_, session_, wishes_);
    }
    EXPECT_EQ(panel_.find("Lesson (M)")->x, before.x);
    switchPanel();
    panel_.setPicture(1280, 1000, 800, 1, 0.02);
    panel_.layOut(controls_, session_, wishes_);
    EXPECT_LT(panel_.find("Start")->x, 800) << "the panel leaves the slices free";
}

TEST_F(LessonClicks, WithoutALessonThereIsNothingOfIt) {
    session_.lesson = nullptr;
    EXPECT_FALSE(isThere("Lesson (M)"));
    EXPECT_EQ(panel_.drawData(), nullptr);
    switchPanel();
    EXPECT_FALSE(isThere("Start"));
    EXPECT_TRUE(isThere("First view (R)"));
}

TEST_F(LessonClicks, ASceneIsLostOnlyAfterAQuestion) {
    switchPanel();
    status_.set_removed_mm3(4);
    click("Pedicle of a vertebra");
    EXPECT_TRUE(wishes_.commands.empty());
    click("Stay (Esc)");
    EXPECT_TRUE(wishes_.commands.empty());
    click("Pedicle of a vertebra");
    click("Change (Enter)");
    EXPECT_EQ(command().choose_scene(), "pedicle");
    EXPECT_FALSE(isThere("Change (Enter)"));
    click("Pedicle of a vertebra");
    click("Pedicle of a vertebra");
    EXPECT_EQ(command().choose_scene(), "pedicle") << "the same once more is an answer, too";
}

TEST_F(LessonClicks, TheKeyAsksForANameAndEnterStarts) {
    controls_.act(Action::kTrainee, session_, wishes_);
    layOut();
    wishes_ = {};
    layOut();
    type("Cleo");
    press(Key::kEnter);
    EXPECT_EQ(command().start_attempt(), "Cleo");
    EXPECT_EQ(settings_.stereo, StereoMode::kOff) << "letters typed were none of the viewer's keys";
    layOut();
    layOut();
    EXPECT_TRUE(send(KeyEvent{keyOf('S'), true, false, {}})) << "the attempt has not begun";
    lesson_.set_is_running(true);
    lesson_.set_start_stamp_ns(1);
    layOut();
    layOut();
    EXPECT_FALSE(send(KeyEvent{keyOf('S'), true, false, {}})) << "keys are the viewer's again";
}

TEST_F(LessonClicks, ADoubleClickStartsOnce) {
    session_.time_s = 10;
    switchPanel();
    click("Start");
    EXPECT_TRUE(command().has_start_attempt());
    lesson_.set_is_running(true);
    session_.time_s = 11.9;
    click("Start");
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_FALSE(isThere("Begin anew (Enter)"));
    session_.time_s = 12.1;
    click("Start");
    click("Begin anew (Enter)");
    EXPECT_TRUE(command().has_start_attempt());
}

TEST_F(LessonClicks, WhoHasNoNameIsCounted) {
    switchPanel();
    click("Start");
    EXPECT_EQ(command().start_attempt(), "3");
}

TEST_F(LessonClicks, AnAttemptIsPausedStoppedAndFollowedByTheNext) {
    switchPanel();
    click("Stop (Shift+F)");
    EXPECT_TRUE(wishes_.commands.empty()) << "none is under way";
    lesson_.set_is_running(true);
    click("Pause (P)");
    EXPECT_TRUE(command().pause_milling());
    click("Stop (Shift+F)");
    EXPECT_TRUE(command().stop_attempt());
    click("Next trainee");
    EXPECT_TRUE(wishes_.commands.empty()) << "an attempt would end";
    click("End it (Enter)");
    EXPECT_TRUE(command().stop_attempt());
    lesson_.set_is_running(false);
    layOut();
    type("Dora");
    press(Key::kEnter);
    EXPECT_EQ(command().start_attempt(), "Dora");
}

TEST_F(LessonClicks, KeysDoTheSame) {
    controls_.act(Action::kNextScene, session_, wishes_);
    EXPECT_EQ(command().choose_scene(), "pedicle");
    lesson_.set_scene_id("pedicle");
    wishes_ = {};
    controls_.act(Action::kNextScene, session_, wishes_);
    EXPECT_EQ(command().choose_scene(), "cavity") << "the third has a problem";
    wishes_ = {};
    controls_.act(Action::kStopAttempt, session_, wishes_);
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_TRUE(wishes_.notice);
    lesson_.set_is_running(true);
    controls_.act(Action::kStopAttempt, session_, wishes_);
    EXPECT_TRUE(command().stop_attempt());
}

TEST_F(LessonClicks, AViewerSeesAndDoesNotPress) {
    session_.role = topics::Viewer::VIEWER;
    lesson_.set_is_running(true);
    switchPanel();
    for (const char* label : {"Pedicle of a vertebra", "Start", "Pause (P)", "Stop (Shift+F)"}) {
        click(label);
        EXPECT_TRUE(wishes_.commands.empty()) << label;
    }
    controls_.act(Action::kNextScene, session_, wishes_);
    EXPECT_TRUE(wishes_.commands.empty());
    ASSERT_TRUE(wishes_.notice);
    EXPECT_NE(wishes_.notice->text.find("--role operator"), std::string::npos);
    click("Save as CSV");
    EXPECT_TRUE(wishes_.save_attempts) << "reading is allowed";
}

TEST_F(LessonClicks, TheSummaryComesWithTheEndOfAnAttemptAndGoes) {
    EXPECT_FALSE(isThere("Close")) << "attempts from before are old news";
    lesson_.set_is_running(true);
    layOut();
    lesson_.set_is_running(false);
    *lesson_.add_attempts() = lesson_.attempts(1);
    lesson_.mutable_attempts(2)->set_number(3);
    EXPECT_TRUE(isThere("Close"));
    click("All attempts as CSV");
    EXPECT_TRUE(wishes_.save_attempts);
    click("Close");
    EXPECT_FALSE(isThere("Close"));
    lesson_.mutable_attempts(2)->set_number(4);
    lesson_.set_epoch(8);
    EXPECT_TRUE(isThere("Close")) << "a change of scene ends an attempt, too";
    lesson_.set_is_running(true);
    EXPECT_FALSE(isThere("Close")) << "the next one has begun";
    *lesson_.add_attempts() = lesson_.attempts(1);
    lesson_.mutable_attempts(3)->set_number(5);
    lesson_.set_start_stamp_ns(2);
    EXPECT_FALSE(isThere("Close")) << "one ended as the next one began";
}

TEST_F(LessonClicks, WhatASummarysRowOfButtonsHasNoRoomForIsBelowIt) {
    session_.class_folder = "/class";
    lesson_.mutable_attempts(0)->mutable_verdict()->set_results("first");
    switchPanel();
    click("Attempt 1");
    for (const bool can_replay : {false, true}) {
        session_.has_launcher = can_replay;
        for (int n = 0; n < 3; ++n) ControlledPanel::layOut(1280, 800);
        const double row = panel_.find("Close")->y, last = panel_.find("All attempts as CSV")->y;
        EXPECT_EQ(panel_.find("Report")->y, row);
        EXPECT_EQ(panel_.find("Replay").has_value(), can_replay);
        EXPECT_EQ(last > row, can_replay);
    }
    clickAt("All attempts as CSV");
    EXPECT_TRUE(wishes_.save_attempts);
}

TEST(LessonDraft, TheAttemptsClockCountsWithoutPauses) {
    topics::Lesson lesson = test::makeLesson();
    topics::Status status;
    SessionView session;
    session.lesson = &lesson;
    session.status = &status;
    LessonDraft draft, late;
    const auto timeAt = [&](double time_s) {
        session.time_s = time_s;
        draft.follow(session);
        return draft.attemptTime();
    };
    EXPECT_FALSE(timeAt(100));
    lesson.set_is_running(true);
    lesson.set_start_stamp_ns(5'000'000'000);
    EXPECT_DOUBLE_EQ(timeAt(101).value(), 0);
    EXPECT_DOUBLE_EQ(timeAt(103).value(), 2);
    status.set_is_milling_paused(true);
    EXPECT_DOUBLE_EQ(timeAt(113).value(), 2);
    session.realtime_ns = 17'000'000'000;
    late.follow(session);
    EXPECT_DOUBLE_EQ(late.attemptTime().value(), 12) << "it came later";
    lesson.set_start_stamp_ns(9'000'000'000);
    status.set_is_milling_paused(false);
    EXPECT_DOUBLE_EQ(timeAt(114).value(), 0) << "another one";
    lesson.set_is_running(false);
    EXPECT_FALSE(timeAt(115));
}

TEST(LessonDraft, TheTaskFadesAfterAWhileAndComesWithTheNextAttempt) {
    topics::Lesson lesson = test::makeLesson();
    SessionView session;
    session.lesson = &lesson;
    session.time_s = 100;
    LessonDraft draft;
    EXPECT_EQ(draft.taskOpacity(100), 0);
    draft.follow(session);
    EXPECT_EQ(draft.taskOpacity(101), 1) << "a new scene";
    EXPECT_EQ(draft.taskOpacity(113), 0);
    session.time_s = 200;
    draft.follow(session);
    EXPECT_EQ(draft.taskOpacity(200), 0) << "the same one";
    lesson.set_is_running(true);
    draft.follow(session);
    EXPECT_EQ(draft.taskOpacity(200), 1);
    EXPECT_GT(draft.taskOpacity(211), 0);
    EXPECT_LT(draft.taskOpacity(211), 1);
}

TEST(ScenePictures, WhatIsNoPictureIsLeftOut) {
    topics::Lesson lesson = test::makeLesson();
    lesson.mutable_scenes(0)->set_picture("not a picture");
    lesson.mutable_scenes(1)->set_picture("\x89PNG\r\n\x1a\n and then nothing");
    SessionView session;
    session.lesson = &lesson;
    ScenePictures pictures;
    pictures.follow(session);
    EXPECT_EQ(pictures.all().size(), 3u);
    for (const auto& [id, picture] : pictures.all()) EXPECT_EQ(picture.number, 0) << id;
    lesson.mutable_scenes()->DeleteSubrange(1, 2);
    pictures.follow(session);
    EXPECT_EQ(pictures.all().size(), 1u);
}

}  // namespace
}  // namespace bonemill
