#include <gtest/gtest.h>

#include "tests/unit/haptic_server/server/session/fake_replay.h"
#include "tests/unit/haptic_server/server/session/session_commands_rig.h"

namespace bonemill {
namespace {

using test::SessionCommandsTest;

TEST_F(SessionCommandsTest, WhoOnlyLooksChoosesNoSceneAndBeginsNoAttempt) {
    for (const topics::Command& command : {choiceOf("tooth"), startOf("Ann"), stop()})
        EXPECT_EQ(
            order(command, topics::Viewer::VIEWER),
            "refused: a viewer only looks; to do this, join again as operator (docs/howto/security.md)");
    EXPECT_FALSE(lesson_.takeOrder());
    EXPECT_FALSE(lesson_.isAttemptRunning());
}

TEST_F(SessionCommandsTest, ASceneIsOrderedOnceAndAnsweredWhenItIsThere) {
    EXPECT_EQ(order(choiceOf("skull\n")),
              "refused: there is no scene 'skull?'; haptic_server --list-scenes shows which there are");
    EXPECT_EQ(order(choiceOf("tooth")), "nothing said");
    EXPECT_EQ(lesson_.takeChanged()->changing_to(), "tooth");
    EXPECT_EQ(order(choiceOf("tooth")), "refused: the scene tooth is on its way; wait for it");
    const auto taken = lesson_.takeOrder();
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->file, "/scenes/tooth.textproto");
    EXPECT_EQ(order(choiceOf("tooth")), "refused: the scene tooth is on its way; wait for it");
    lesson_.answerOrder(taken->command, Answer::refused("no such volume"));
    EXPECT_EQ(lesson_.takeAnswers().at(0).second.text, "refused: no such volume");
    EXPECT_TRUE(lesson_.takeAnswers().empty());
    EXPECT_EQ(lesson_.takeChanged()->changing_to(), "");
    EXPECT_EQ(order(choiceOf("tooth")), "nothing said");
}

TEST_F(SessionCommandsTest, WhatChangesOfTheLessonTravelsWithoutPictures) {
    EXPECT_EQ(lesson_.takeChanged()->scenes(0).picture(), "");
    EXPECT_EQ(lesson_.scenes().at(0).choice.picture(), "a picture");
    EXPECT_EQ(order(startOf("Ann")), "done");
    EXPECT_EQ(lesson_.takeChanged()->scenes(0).picture(), "");
}

TEST_F(SessionCommandsTest, AnAttemptCountsFromZeroAndIsListed) {
    TickRecord before{};
    before.f_hand_W[2] = 9;
    before.contacts = 1;
    ring_.tryPush(before);
    recorder_.drain();
    EXPECT_EQ(order(stop()), "refused: no attempt is under way");
    ball_.history.pauseMilling(true);
    EXPECT_EQ(order(startOf("Ann")), "done");
    EXPECT_FALSE(ball_.history.isMillingPaused());
    TickRecord record{};
    record.contacts = 1;
    record.f_hand_W[0] = 3;
    record.f_hand_W[1] = 4;
    ball_.restoreAll();
    ball_.groove(10e-3);
    record.bone_order = ball_.history.finishedOrder();
    ring_.tryPush(record);
    recorder_.drain();
    EXPECT_TRUE(lesson_.takeChanged()->is_running());
    EXPECT_EQ(order(startOf("Bob \xc3\xa4")), "done") << "ends the one under way";
    ball_.restoreAll();
    ball_.groove(10e-3);
    EXPECT_EQ(order(stop()), "done");
    EXPECT_EQ(told_, "bbe");
    const auto lesson = lesson_.takeChanged();
    ASSERT_EQ(lesson->attempts_size(), 2);
    EXPECT_FALSE(lesson->is_running());
    EXPECT_EQ(lesson->trainee(), "Bob \xc3\xa4");
    EXPECT_EQ(lesson->attempts(0).trainee(), "Ann");
    EXPECT_EQ(lesson->attempts(0).number(), 1u);
    EXPECT_DOUBLE_EQ(lesson->attempts(0).max_force_n(), 5);
    EXPECT_EQ(lesson->attempts(1).number(), 2u);
    EXPECT_EQ(lesson->attempts(1).max_force_n(), 0);
}

// The summary stands still only while the bone does.
TEST_F(SessionCommandsTest, AfterAnAttemptMillingIsPausedUntilTheNextOne) {
    EXPECT_EQ(order(startOf("Ann")), "done");
    ball_.restoreAll();
    ball_.groove(10e-3);
    EXPECT_EQ(order(stop()), "done");
    EXPECT_TRUE(ball_.history.isMillingPaused());
    topics::Command resume;
    resume.set_pause_milling(false);
    EXPECT_EQ(order(resume), "done");
    EXPECT_FALSE(ball_.history.isMillingPaused());
    EXPECT_EQ(order(startOf("Bob")), "done");
    EXPECT_FALSE(ball_.history.isMillingPaused());
}

TEST_F(SessionCommandsTest, AnAttemptThatWasBegunByMistakeIsNotRecorded) {
    EXPECT_EQ(order(startOf("Ann")), "done");
    ball_.restoreAll();
    EXPECT_EQ(order(startOf("Ann")), "done") << "pressed twice";
    ball_.restoreAll();
    ball_.groove(10e-3);
    EXPECT_EQ(order(stop()), "done");
    EXPECT_EQ(order(startOf("Bob")), "done");
    EXPECT_EQ(order(stop()), "done") << "while the bone goes back";
    const auto lesson = lesson_.takeChanged();
    EXPECT_FALSE(lesson->is_running());
    ASSERT_EQ(lesson->attempts_size(), 1);
    EXPECT_EQ(lesson->attempts(0).number(), 1u);
    EXPECT_EQ(lesson->attempts(0).trainee(), "Ann");
    EXPECT_GT(lesson->attempts(0).removed_mm3(), 0);
}

TEST_F(SessionCommandsTest, WhatViewersRememberOfTheBoneIsOfTheBoneThatWasPutBackLast) {
    const auto restores = [this] { return told().bone_restores(); };
    EXPECT_EQ(restores(), 0u);
    EXPECT_EQ(order(startOf("Ann")), "done");
    EXPECT_EQ(restores(), 1u);
    ball_.restoreAll();
    topics::Command reset;
    reset.set_reset_volume(true);
    EXPECT_EQ(order(reset), "done");
    EXPECT_EQ(restores(), 2u);
}

// A status shows the attempt's; outside of attempts those since the bone was put back.
TEST_F(SessionCommandsTest, FiguresBeginAnewWithAnAttemptAndWithBoneThatIsPutBackOutsideOfOne) {
    const auto felt = [this](double force) {
        TickRecord record{};
        record.contacts = 1;
        record.f_hand_W[0] = force;
        record.bone_order = ball_.history.finishedOrder();
        ring_.tryPush(record);
        recorder_.drain();
        return recorder_.attempt().max_force;
    };
    topics::Command reset;
    reset.set_reset_volume(true);
    EXPECT_EQ(felt(9), 9) << "before the first attempt";
    EXPECT_EQ(order(reset), "done");
    ball_.restoreAll();
    EXPECT_EQ(felt(3), 3);
    EXPECT_EQ(order(startOf("Ann")), "done");
    ball_.restoreAll();
    EXPECT_EQ(felt(2), 2);
    EXPECT_EQ(order(reset), "done");
    ball_.restoreAll();
    EXPECT_EQ(felt(1), 2) << "the attempt goes on";
}

TEST_F(SessionCommandsTest, AFloodOfOrdersIsRefusedAndOthersAreNot) {
    int done = 0;
    std::string last;
    for (int n = 0; n < 200; ++n) {
        last = setAccuracy(n % 2 ? "fast" : "balanced");
        done += last == "done";
    }
    EXPECT_GE(done, 12);
    EXPECT_LE(done, 14);
    EXPECT_EQ(last, "refused: that was too often: it works once in 2 s; wait, then try again");
    for (int n = 0; n < 50; ++n) order(startOf("Ann"));
    EXPECT_EQ(order(stop()), "refused: that was too often: it works once in 2 s; wait, then try again");
    topics::Command pause;
    pause.set_pause_milling(true);
    EXPECT_EQ(order(pause), "done");
}

TEST_F(SessionCommandsTest, TraineesHaveNamesThatCanBeShown) {
    for (const std::string& name : {std::string(), std::string("  "), std::string(49, 'x'),
                                    std::string("a\nb"), std::string("\x1b[2J"), std::string("a\xc2\x85")})
        EXPECT_EQ(order(startOf(name)).rfind("refused: ", 0), 0u) << name;
    EXPECT_FALSE(lesson_.isAttemptRunning());
    EXPECT_EQ(order(startOf("=1+2")), "done");
}

TEST_F(SessionCommandsTest, NotesAreForWhoMayCommandAndNotTooOften) {
    topics::Command note, erase;
    note.mutable_add_remark()->set_note("here");
    erase.set_erase_remark(1);
    for (const topics::Command& command : {note, erase})
        EXPECT_EQ(
            order(command, topics::Viewer::VIEWER),
            "refused: a viewer only looks; to do this, join again as operator (docs/howto/security.md)");
    EXPECT_EQ(commands_.remarks().count(), 0u);
    EXPECT_EQ(order(note, topics::Viewer::EXAMINER), "done");
    EXPECT_EQ(order(erase), "done");
    EXPECT_EQ(commands_.remarks().count(), 0u);
    int taken = 0;
    for (int n = 0; n < 100; ++n) taken += order(note) == "done";
    EXPECT_GE(taken, 19);
    EXPECT_LT(taken, 60);
    EXPECT_EQ(order(note), "refused: that was too often: it works once in 1 s; wait, then try again");
    erase.set_erase_remark(0);
    EXPECT_EQ(order(erase), "done") << "a flood can be cleared away";
}

TEST_F(SessionCommandsTest, OfAttemptsTheOldestAreForgotten) {
    for (int n = 0; n < LessonState::kMaxAttempts + 3; ++n) {
        lesson_.beginAttempt("Ann");
        lesson_.endAttempt({});
    }
    const auto lesson = lesson_.takeChanged();
    EXPECT_EQ(lesson->attempts_size(), LessonState::kMaxAttempts);
    EXPECT_EQ(lesson->attempts(0).number(), 4u);
}

const std::string kPresets = "; " + presetNames() + " or scene";

TEST_F(SessionCommandsTest, APresetsNameIsTakenAndAnUnknownOneRefused) {
    EXPECT_EQ(setAccuracy("fast"), "done");
    EXPECT_EQ(setAccuracy("best"), std::string("refused: no preset is called 'best'") + kPresets);
}

TEST_F(SessionCommandsTest, AnotherLawIsRefusedWhereAnEffectNeedsTheGradientLaw) {
    EXPECT_EQ(setAccuracy("thesis_2012"), "done");
    scene::Scene scene = sceneOf();
    scene.mutable_effects()->mutable_energy_removal();
    SessionCommands commands(scene, ball_.bone, recorder_, controls(), false);
    topics::Command command;
    command.set_role(topics::Viewer::OPERATOR);
    for (const std::string law : {"thesis_2012", "proxy_3dof"}) {
        command.set_set_accuracy(law);
        EXPECT_EQ(commands.carryOut(command)->text,
                  "refused: effects.energy_removal of the scene needs the gradient contact law, which " +
                      law + " is not");
    }
    command.set_set_accuracy("exact");
    EXPECT_EQ(commands.carryOut(command)->outcome, topics::DONE);
}

TEST_F(SessionCommandsTest, WhatIsFalseIsRefusedAndNotDone) {
    constexpr void (topics::Command::*kActions[])(bool) = {
        &topics::Command::set_stop_attempt,    &topics::Command::set_reset_volume,
        &topics::Command::set_save_checkpoint, &topics::Command::set_shut_down,
        &topics::Command::set_reset_device,    &topics::Command::set_begin_again,
        &topics::Command::set_take_over};
    for (const auto set : kActions) {
        topics::Command command;
        command.set_role(topics::Viewer::INSTRUCTOR);
        (command.*set)(false);
        EXPECT_EQ(commands_.carryOut(command)->text,
                  "refused: a command that is false asks for nothing; send true");
    }
    EXPECT_FALSE(stop_requested_);
    EXPECT_EQ(reset_orders_, 0u);
    EXPECT_EQ(told().checkpoints_size(), 0);
    topics::Command command;
    command.set_role(topics::Viewer::INSTRUCTOR);
    command.set_save_checkpoint(true);
    EXPECT_EQ(commands_.carryOut(command)->outcome, topics::DONE);
    command.set_shut_down(true);
    EXPECT_EQ(commands_.carryOut(command)->outcome, topics::DONE);
    EXPECT_TRUE(stop_requested_);
}

TEST_F(SessionCommandsTest, OperatorsAndInstructorsResetTheDevice) {
    topics::Command command;
    command.set_reset_device(true);
    EXPECT_EQ(commands_.carryOut(command)->outcome, topics::REFUSED);
    uint32_t orders = 0;
    for (const auto role : {topics::Viewer::OPERATOR, topics::Viewer::INSTRUCTOR}) {
        command.set_role(role);
        EXPECT_EQ(commands_.carryOut(command)->outcome, topics::DONE);
        EXPECT_EQ(reset_orders_, ++orders);
    }
}

// The refusal is kept and sent to everyone.
TEST_F(SessionCommandsTest, OfAnUnknownNameOnly32PrintableCharactersAreRepeated) {
    EXPECT_EQ(setAccuracy(std::string(3000, 'x')),
              "refused: no preset is called '" + std::string(32, 'x') + "...'" + kPresets);
    EXPECT_EQ(setAccuracy(std::string(32, 'x')),
              "refused: no preset is called '" + std::string(32, 'x') + "'" + kPresets);
    EXPECT_EQ(setAccuracy(std::string("a\n\x1b[2Jb\0c\x7f", 10)),
              std::string("refused: no preset is called 'a??[2Jb?c?'") + kPresets);
    EXPECT_EQ(setAccuracy("gr\xc3\xbcn"), std::string("refused: no preset is called 'gr??n'") + kPresets);
}

TEST_F(SessionCommandsTest, ALiveSessionIsNoReplay) {
    topics::Command command;
    command.mutable_replay()->set_seek_s(3);
    EXPECT_EQ(order(command).substr(0, 7), "refused");
    EXPECT_FALSE(told().has_replay());
}

TEST_F(SessionCommandsTest, AReplayIsLedAndItsBoneStaysAsItWas) {
    test::FakeReplay replay;
    SessionControls in_replay = controls();
    in_replay.replay = &replay;
    SessionCommands commands(sceneOf(), ball_.bone, recorder_, in_replay, false);
    const auto tell = [&](topics::Command command, topics::Viewer::Role role = topics::Viewer::OPERATOR) {
        command.set_role(role);
        return commands.carryOut(command).value_or(Answer{.text = "nothing said"}).text.substr(0, 7);
    };
    topics::Command seek, pause, tool, reset, bone, shut_down;
    seek.mutable_replay()->set_seek_s(3);
    pause.set_pause_milling(true);
    tool.set_select_tool(0);
    reset.set_reset_volume(true);
    bone.set_export_("name");
    shut_down.set_shut_down(true);
    EXPECT_EQ(tell(seek), "done");
    EXPECT_EQ(tell(seek, topics::Viewer::VIEWER), "refused");
    EXPECT_EQ(tell(pause), "done");
    pause.set_pause_milling(false);
    EXPECT_EQ(tell(pause), "done");
    EXPECT_EQ(replay.said_, "seek 3 hold play ");
    for (const topics::Command& command : {tool, reset, bone}) EXPECT_EQ(tell(command), "refused");
    EXPECT_EQ(ball_.history.newestOrder(), 0u);
    topics::Status status;
    commands.describe(status);
    EXPECT_EQ(status.replay().length_s(), 60);
    EXPECT_EQ(tell(shut_down, topics::Viewer::INSTRUCTOR), "done");
    EXPECT_TRUE(stop_requested_);
}

}  // namespace
}  // namespace bonemill
