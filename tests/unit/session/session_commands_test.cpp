#include "haptic_server/session/session_commands.h"

#include <gtest/gtest.h>

#include "tests/unit/bone/milled_ball.h"

namespace bonemill {
namespace {

class SessionCommandsTest : public testing::Test {
  protected:
    SessionCommandsTest()
        : ring_(16),
          recorder_(ring_, 1'000'000),
          tool_(test::sphereToolModel(1e-3, 0.2e-3)),
          accuracy_(presetSettings(Preset::kBalanced)),
          tools_(std::vector<SpoTool>{{&tool_, {.radius = 1e-3}, 5}}, 0),
          bone_export_(ball_.history, ball_.bone, ""),
          commands_(sceneOf(), ball_.bone, recorder_,
                    {ball_.history, accuracy_, tools_, stop_requested_, bone_export_, reset_orders_}, false) {
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
        return commands_.carryOut(command).value_or("nothing said");
    }

    test::MilledBall ball_;
    SpscRing<TickRecord> ring_;
    Recorder recorder_;
    ToolModel tool_;
    AccuracySwitch accuracy_;
    ToolSwitch tools_;
    std::atomic<bool> stop_requested_{false};
    SessionExport bone_export_;
    std::atomic<uint32_t> reset_orders_{0};
    SessionCommands commands_;
};

const std::string kPresets = "; " + presetNames() + " or scene";

TEST_F(SessionCommandsTest, APresetsNameIsTakenAndAnUnknownOneRefused) {
    EXPECT_EQ(setAccuracy("fast"), "done");
    EXPECT_EQ(setAccuracy("best"), std::string("refused: no preset is called 'best'") + kPresets);
}

TEST_F(SessionCommandsTest, AnotherLawIsRefusedWhereAnEffectNeedsTheGradientLaw) {
    EXPECT_EQ(setAccuracy("thesis_2012"), "done");
    scene::Scene scene = sceneOf();
    scene.mutable_effects()->mutable_energy_removal();
    SessionCommands commands(scene, ball_.bone, recorder_,
                             {ball_.history, accuracy_, tools_, stop_requested_, bone_export_, reset_orders_},
                             false);
    topics::Command command;
    command.set_role(topics::Viewer::OPERATOR);
    for (const std::string law : {"thesis_2012", "proxy_3dof"}) {
        command.set_set_accuracy(law);
        EXPECT_EQ(commands.carryOut(command),
                  "refused: effects.energy_removal of the scene needs the gradient contact law, which " +
                      law + " is not");
    }
    command.set_set_accuracy("exact");
    EXPECT_EQ(commands.carryOut(command), "done");
}

TEST_F(SessionCommandsTest, WhatIsFalseIsRefusedAndNotDone) {
    constexpr void (topics::Command::*kActions[])(bool) = {
        &topics::Command::set_reset_volume, &topics::Command::set_save_checkpoint,
        &topics::Command::set_shut_down, &topics::Command::set_reset_device};
    for (const auto set : kActions) {
        topics::Command command;
        command.set_role(topics::Viewer::INSTRUCTOR);
        (command.*set)(false);
        EXPECT_EQ(commands_.carryOut(command),
                  "refused: a command that is false asks for nothing; send true");
    }
    EXPECT_FALSE(stop_requested_);
    EXPECT_EQ(reset_orders_, 0u);
    topics::Status status;
    commands_.describe(status);
    EXPECT_EQ(status.checkpoints_size(), 0);
    topics::Command command;
    command.set_role(topics::Viewer::INSTRUCTOR);
    command.set_save_checkpoint(true);
    EXPECT_EQ(commands_.carryOut(command), "done");
    command.set_shut_down(true);
    EXPECT_EQ(commands_.carryOut(command), "done");
    EXPECT_TRUE(stop_requested_);
}

TEST_F(SessionCommandsTest, OperatorsAndInstructorsResetTheDevice) {
    topics::Command command;
    command.set_reset_device(true);
    EXPECT_NE(commands_.carryOut(command)->find("refused"), std::string::npos);
    uint32_t orders = 0;
    for (const auto role : {topics::Viewer::OPERATOR, topics::Viewer::INSTRUCTOR}) {
        command.set_role(role);
        EXPECT_EQ(commands_.carryOut(command), "done");
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

}  // namespace
}  // namespace bonemill
