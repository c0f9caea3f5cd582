#include <gtest/gtest.h>

#include "render_client/hand/controls/session_view.h"
#include "tests/support/controlled_viewer.h"

namespace bonemill {
namespace {

class Questions : public testing::Test, protected test::ControlledViewer {
  protected:
    void send(const WindowEvent& event) { controls_.handle(event, 500, session_, wishes_); }
    void type(char letter) {
        send(KeyEvent{keyOf(letter), true, false, {}});
        send(KeyEvent{keyOf(letter), false, false, {}});
    }
};

TEST_F(Questions, AskBeforeUnsavedWorkIsLost) {
    topics::Checkpoint& checkpoint = *status_.add_checkpoints();
    checkpoint.set_id(1);
    checkpoint.set_removed_mm3(3);
    status_.set_removed_mm3(5);
    type('C');
    EXPECT_TRUE(wishes_.commands.empty());
    ASSERT_TRUE(controls_.question(session_));
    const std::string text = controls_.question(session_)->text;
    EXPECT_EQ(wishes_.asked, text);
    EXPECT_NE(text.find("5.00 mm\u00b3 are milled"), std::string::npos) << text;
    type('U');
    EXPECT_TRUE(wishes_.commands.empty()) << "another question";
    type('C');
    EXPECT_TRUE(wishes_.commands.empty()) << "that was asked before the other one";
    type('C');
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_TRUE(wishes_.commands[0].reset_volume());
    type('C');
    EXPECT_EQ(wishes_.commands.size(), 1u) << "an answer counts once";
    session_.time_s += 1000;
    status_.set_removed_mm3(6);
    ASSERT_TRUE(controls_.question(session_)) << "it stands until it is answered";
    EXPECT_NE(controls_.question(session_)->text.find("6.00 mm\u00b3"), std::string::npos);
    type('C');
    EXPECT_EQ(wishes_.commands.size(), 2u);
    EXPECT_FALSE(controls_.question(session_));
}

TEST_F(Questions, AnswersAreYesNoAndSaveFirst) {
    using Answer = ViewerControls::Answer;
    status_.set_removed_mm3(5);
    type('C');
    controls_.answer(Answer::kNo, session_, wishes_);
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_FALSE(controls_.question(session_));
    controls_.answer(Answer::kYes, session_, wishes_);
    EXPECT_TRUE(wishes_.commands.empty()) << "nothing was asked";
    type('C');
    EXPECT_TRUE(controls_.question(session_)->offers_checkpoint);
    controls_.answer(Answer::kSaveFirst, session_, wishes_);
    ASSERT_EQ(wishes_.commands.size(), 2u);
    EXPECT_TRUE(wishes_.commands[0].save_checkpoint());
    EXPECT_TRUE(wishes_.commands[1].reset_volume());
    type('C');
    status_.set_removed_mm3(0);
    controls_.dropIdleQuestion(session_);
    status_.set_removed_mm3(5);
    EXPECT_FALSE(controls_.question(session_)) << "there was nothing to be lost meanwhile";
}

TEST_F(Questions, EscLeavesTheHelpAndAsksBeforeItCloses) {
    type('H');
    send(KeyEvent{Key::kEscape, true, false, {}});
    EXPECT_FALSE(settings_.show_help);
    EXPECT_FALSE(controls_.question(session_));
    send(KeyEvent{Key::kEscape, true, false, {}});
    EXPECT_FALSE(wishes_.quit);
    EXPECT_TRUE(controls_.question(session_));
    controls_.answer(ViewerControls::Answer::kYes, session_, wishes_);
    EXPECT_TRUE(wishes_.quit);
}

TEST_F(Questions, AStartAsksOnlyWhereAnAttemptEndsAndKeepsWhatIsMilled) {
    topics::Lesson lesson;
    session_.lesson = &lesson;
    topics::Command start;
    start.set_start_attempt("Ben");
    status_.set_removed_mm3(5);
    controls_.request(start, session_, wishes_);
    ASSERT_EQ(wishes_.commands.size(), 2u);
    EXPECT_TRUE(wishes_.commands[0].save_checkpoint()) << "no trainee's, but somebody's";
    EXPECT_EQ(wishes_.commands[1].start_attempt(), "Ben");
    wishes_ = {};
    lesson.set_is_running(true);
    lesson.set_trainee("Anna");
    session_.time_s += 60;
    controls_.request(start, session_, wishes_);
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_NE(controls_.question(session_)->text.find("End Anna's attempt?"), std::string::npos);
    controls_.answer(ViewerControls::Answer::kYes, session_, wishes_);
    ASSERT_EQ(wishes_.commands.size(), 1u) << "her attempt's record is in the class";
    topics::Command scene;
    scene.set_choose_scene("skull");
    status_.set_removed_mm3(0);
    wishes_ = {};
    controls_.request(scene, session_, wishes_);
    EXPECT_NE(controls_.question(session_)->text.find("Anna's attempt ends"), std::string::npos);
    EXPECT_TRUE(wishes_.commands.empty());
}

TEST_F(Questions, DoNotAskWhereNothingIsLost) {
    type('C');
    EXPECT_EQ(wishes_.commands.size(), 1u) << "nothing was milled";
    topics::Checkpoint& checkpoint = *status_.add_checkpoints();
    checkpoint.set_removed_mm3(5);
    status_.set_removed_mm3(5);
    type('C');
    type('U');
    EXPECT_EQ(wishes_.commands.size(), 3u) << "the checkpoint has it";
    status_.set_removed_mm3(7);
    type('K');
    type('P');
    EXPECT_EQ(wishes_.commands.size(), 5u) << "these lose nothing";
}

}  // namespace
}  // namespace bonemill
