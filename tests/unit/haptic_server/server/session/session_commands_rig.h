// A session's commands over a ball of bone that a burr has milled, without device and without viewers.
#pragma once

#include <gtest/gtest.h>

#include "haptic_server/server/session/session_commands.h"
#include "tests/unit/haptic_server/core/bone/milled_ball.h"

namespace bonemill::test {

class SessionCommandsTest : public testing::Test {
  protected:
    SessionCommandsTest()
        : ring_(16),
          recorder_(ring_, 1'000'000),
          tool_(sphereToolModel(1e-3, 0.2e-3)),
          accuracy_(presetSettings(Preset::kBalanced)),
          tools_(std::vector<SpoTool>{{&tool_, {.radius = 1e-3}, 5}}, 0),
          bone_export_(ball_.history, ball_.bone, ""),
          attempts_(lesson_, recorder_, ball_.history, journal_, ball_.bone, sceneOf(),
                    [this](bool begins) { told_ += begins ? 'b' : 'e'; }),
          commands_(sceneOf(), ball_.bone, recorder_, controls(), false) {}

    static std::vector<ListedScene> listed() {
        ListedScene scene{.choice = {}, .file = "/scenes/tooth.textproto"};
        scene.choice.set_id("tooth");
        scene.choice.set_picture("a picture");
        return {scene};
    }
    SessionControls controls() {
        return {ball_.history, accuracy_, tools_,  stop_requested_, bone_export_, reset_orders_,
                lesson_,       attempts_, limits_, journal_,        hand_};
    }
    std::string order(topics::Command command, topics::Viewer::Role role = topics::Viewer::OPERATOR) {
        command.set_role(role);
        if (const auto answer = commands_.carryOut(command)) return answer->text;
        const auto answers = lesson_.takeAnswers();
        return answers.empty() ? "nothing said" : answers.front().second.text;
    }
    static topics::Command startOf(const std::string& trainee) {
        topics::Command command;
        command.set_start_attempt(trainee);
        return command;
    }
    static topics::Command stop() {
        topics::Command command;
        command.set_stop_attempt(true);
        return command;
    }
    static topics::Command choiceOf(const std::string& id) {
        topics::Command command;
        command.set_choose_scene(id);
        return command;
    }

    static scene::Scene sceneOf() {
        scene::Scene scene;
        scene.mutable_accuracy()->set_switchable(true);
        return scene;
    }
    std::string setAccuracy(const std::string& name) {
        topics::Command command;
        command.set_role(topics::Viewer::OPERATOR);
        command.set_set_accuracy(name);
        return commands_.carryOut(command).value_or(Answer{.text = "nothing said"}).text;
    }
    topics::Status told() {
        topics::Status status;
        commands_.describe(status);
        return status;
    }

    MilledBall ball_;
    SpscRing<TickRecord> ring_;
    Recorder recorder_;
    ToolModel tool_;
    AccuracySwitch accuracy_;
    ToolSwitch tools_;
    std::atomic<bool> stop_requested_{false};
    SessionExport bone_export_;
    std::atomic<uint32_t> reset_orders_{0};
    LessonState lesson_{listed(), ClassTable("")};
    std::string told_;                                    // to the device
    JournalRecorder journal_{ball_.history, ball_.bone};  // that goes nowhere
    AttemptController attempts_;
    OrderLimits limits_;
    std::string wanted_hands_;
    ScriptedHand hand_{recorder_,
                       [this](HandChoice hand) { wanted_hands_ += hand == HandChoice::kOwn ? 'o' : 'p'; }};
    SessionCommands commands_;
};

}  // namespace bonemill::test
