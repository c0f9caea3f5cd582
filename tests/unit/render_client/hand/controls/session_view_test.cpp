#include "render_client/hand/controls/session_view.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

struct Session {
    topics::SceneInfo info;
    topics::Status status;

    SessionView view(topics::Viewer::Role role = topics::Viewer::OPERATOR) const {
        SessionView view;
        view.role = role;
        view.has_server = true;
        view.info = &info;
        view.status = &status;
        return view;
    }
    topics::Command ask(Action action) const {
        const CommandOrReason asked = commandOf(action, view());
        EXPECT_TRUE(asked.command) << asked.why_not;
        return asked.command.value_or(topics::Command());
    }
};

TEST(SessionCommands, AreWhatTheActionsSay) {
    Session session;
    EXPECT_TRUE(session.ask(Action::kResetBone).reset_volume());
    EXPECT_TRUE(session.ask(Action::kSaveCheckpoint).save_checkpoint());
    EXPECT_TRUE(session.ask(Action::kResetDevice).reset_device());
    EXPECT_EQ(session.ask(Action::kAccuracyScene).set_accuracy(), "scene");
    EXPECT_EQ(session.ask(Action::kAccuracy1).set_accuracy(), "thesis_2012");
    EXPECT_EQ(session.ask(Action::kAccuracy4).set_accuracy(), "exact");
}

TEST(SessionCommands, AfterAScriptItBeginsAgainOrIsTakenOver) {
    Session session;
    EXPECT_FALSE(commandOf(Action::kAgain, session.view()).command);
    EXPECT_NE(whyNotTakeOver(session.view()), "");
    session.status.mutable_device()->mutable_script()->set_has_ended(true);
    EXPECT_TRUE(session.ask(Action::kAgain).begin_again());
    EXPECT_EQ(whyNotTakeOver(session.view()), "");
    EXPECT_EQ(whyNotTakeOver(session.view(topics::Viewer::EXAMINER)),
              "An examiner leaves the tool to others");
    EXPECT_NE(whyNotTakeOver(session.view(topics::Viewer::VIEWER)), "");
    session.status.mutable_replay();
    EXPECT_NE(whyNotTakeOver(session.view()), "") << "a recording's hand";
    session.status.clear_replay();

    // A script does its own work again; that of who has taken over would be lost.
    session.status.set_removed_mm3(5);
    const Deed again{Deed::Kind::kCommand, session.ask(Action::kAgain)};
    EXPECT_FALSE(questionBefore(again, session.view()));
    session.status.mutable_device()->mutable_script()->set_has_ended(false);
    session.status.mutable_device()->mutable_script()->set_taken_over_by(7);
    EXPECT_TRUE(isTakenOver(session.view()));
    EXPECT_TRUE(session.ask(Action::kAgain).begin_again());
    EXPECT_NE(whyNotTakeOver(session.view()), "");
    const auto question = questionBefore(again, session.view());
    ASSERT_TRUE(question);
    EXPECT_EQ(question->yes, "Put back");
    EXPECT_TRUE(question->offers_checkpoint);
}

TEST(SessionCommands, PauseFollowsTheServersState) {
    Session session;
    EXPECT_EQ(session.ask(Action::kPauseMilling).action_case(), topics::Command::kPauseMilling);
    EXPECT_TRUE(session.ask(Action::kPauseMilling).pause_milling());
    session.status.set_is_milling_paused(true);
    EXPECT_EQ(session.ask(Action::kPauseMilling).action_case(), topics::Command::kPauseMilling);
    EXPECT_FALSE(session.ask(Action::kPauseMilling).pause_milling());
}

TEST(SessionCommands, BackGoesToTheNewestCheckpoint) {
    Session session;
    EXPECT_FALSE(commandOf(Action::kLastCheckpoint, session.view()).command);
    EXPECT_NE(commandOf(Action::kLastCheckpoint, session.view()).why_not.find("K saves one"),
              std::string::npos);
    session.status.add_checkpoints()->set_id(4);
    session.status.add_checkpoints()->set_id(7);
    EXPECT_EQ(session.ask(Action::kLastCheckpoint).restore_checkpoint(), 7u);
}

TEST(SessionCommands, TheNextToolAfterTheLastIsTheFirst) {
    Session session;
    session.info.add_tool_names("6 mm");
    EXPECT_FALSE(commandOf(Action::kNextTool, session.view()).command);
    session.info.add_tool_names("3 mm");
    EXPECT_EQ(session.ask(Action::kNextTool).select_tool(), 1u);
    session.info.set_tool_index(1);
    EXPECT_EQ(session.ask(Action::kNextTool).select_tool(), 0u);
}

TEST(SessionCommands, AViewerIsToldWhyNot) {
    const Session session;
    const CommandOrReason asked = commandOf(Action::kResetBone, session.view(topics::Viewer::VIEWER));
    EXPECT_FALSE(asked.command);
    EXPECT_NE(asked.why_not.find("--role operator"), std::string::npos) << asked.why_not;
}

TEST(SessionCommands, WithoutAServerNothingIsAsked) {
    const CommandOrReason asked = commandOf(Action::kResetBone, SessionView());
    EXPECT_FALSE(asked.command);
    EXPECT_FALSE(asked.why_not.empty());
}

TEST(SessionCommands, ViewActionsAreNoneOfTheServersBusiness) {
    const CommandOrReason asked = commandOf(Action::kTransparency, SessionView());
    EXPECT_FALSE(asked.command);
    EXPECT_TRUE(asked.why_not.empty());
}

TEST(Roles, OnlyAnInstructorPointsAndEndsTheSession) {
    const Session session;
    using Viewer = topics::Viewer;
    for (const auto role : {Viewer::VIEWER, Viewer::OPERATOR}) {
        EXPECT_FALSE(whyNotPoint(session.view(role)).empty());
        EXPECT_FALSE(whyNotEndSession(session.view(role)).empty());
    }
    EXPECT_TRUE(whyNotPoint(session.view(Viewer::INSTRUCTOR)).empty());
    EXPECT_TRUE(whyNotEndSession(session.view(Viewer::INSTRUCTOR)).empty());
    EXPECT_TRUE(whyNotCommand(session.view(Viewer::OPERATOR)).empty());
}

}  // namespace
}  // namespace bonemill
