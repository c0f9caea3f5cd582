#include "render_client/subscribe/command_words.h"

#include <gtest/gtest.h>

#include "common/user_error.h"

namespace bonemill {
namespace {

class CommandWords : public testing::Test {
  protected:
    CommandWords() {
        scene_.add_tool_names("coarse burr");
        scene_.add_tool_names("fine");
        status_.add_checkpoints()->set_id(4);
        status_.add_checkpoints()->set_id(7);
    }
    topics::Command of(const std::string& text) const { return commandOf(text, scene_, status_); }

    topics::SceneInfo scene_;
    topics::Status status_;
};

TEST_F(CommandWords, EachWordIsItsCommand) {
    EXPECT_TRUE(of("reset").reset_volume());
    EXPECT_TRUE(of("pause").pause_milling());
    EXPECT_EQ(of("resume").action_case(), topics::Command::kPauseMilling);
    EXPECT_FALSE(of("resume").pause_milling());
    EXPECT_TRUE(of(" checkpoint ").save_checkpoint());
    EXPECT_TRUE(of("reset-device").reset_device());
    EXPECT_TRUE(of("shutdown").shut_down());
    EXPECT_EQ(of("scene tooth_cavity").choose_scene(), "tooth_cavity");
    EXPECT_EQ(of("start Ann Lee").start_attempt(), "Ann Lee");
    EXPECT_TRUE(of("stop").stop_attempt());
    EXPECT_EQ(of("accuracy fast").set_accuracy(), "fast");
    EXPECT_EQ(of(" note  mind the nerve ").add_remark().note(), "mind the nerve");
    EXPECT_EQ(of("erase 12").erase_remark(), 12u);
    EXPECT_EQ(of("erase all").action_case(), topics::Command::kEraseRemark);
    EXPECT_EQ(of("erase all").erase_remark(), 0u);
    EXPECT_EQ(of("export after lunch").export_(), "after lunch");
}

TEST_F(CommandWords, ToolsAndCheckpointsAreThoseOfTheSession) {
    EXPECT_EQ(of("tool fine").select_tool(), 1u);
    EXPECT_EQ(of("tool 2").select_tool(), 1u);
    EXPECT_EQ(of("tool  coarse burr").select_tool(), 0u);
    EXPECT_EQ(of("tool coarse burr").action_case(), topics::Command::kSelectTool);
    EXPECT_THROW(of("tool 3"), UserError);
    EXPECT_THROW(of("tool drill"), UserError);
    EXPECT_EQ(of("restore 4").restore_checkpoint(), 4u);
    EXPECT_EQ(of("restore last").restore_checkpoint(), 7u);
    EXPECT_EQ(of("restore 0").action_case(), topics::Command::kRestoreCheckpoint);
    status_.clear_checkpoints();
    EXPECT_THROW(of("restore last"), UserError);
}

TEST_F(CommandWords, WhatIsNoCommandIsRefusedWithoutAServer) {
    for (const char* text : {"", " ", "explode", "pause now", "tool", "restore", "restore first",
                             "restore -1", "restore 4294967296", "accuracy", "export", "scene", "start",
                             "stop it", "note", "erase", "erase 0", "erase everything", "Reset"}) {
        EXPECT_NE(commandProblem(text), "") << text;
        EXPECT_THROW(of(text), UserError) << text;
    }
    EXPECT_NE(commandProblem("export " + std::string(5000, 'a')), "");
    for (const char* text : {"tool anything at all", "restore last", "restore 12", "accuracy best"})
        EXPECT_EQ(commandProblem(text), "") << text;
}

}  // namespace
}  // namespace bonemill
