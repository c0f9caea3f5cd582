#include "render_client/link/subscribe/command_words.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"

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
    EXPECT_TRUE(of("again").begin_again());
    EXPECT_TRUE(of("take-over").take_over());
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

TEST_F(CommandWords, WhatIsTunedIsWordedAsInASceneFile) {
    const topics::Command command = of("tune coupling { damping_time_ms: 2 max_force_n: 6 }");
    EXPECT_EQ(command.tune().coupling().damping_time_ms(), 2);
    EXPECT_EQ(command.tune().coupling().max_force_n(), 6);
    EXPECT_EQ(of("tune scene").action_case(), topics::Command::kTune);
    EXPECT_EQ(of("tune scene").tune().ByteSizeLong(), 0u);
    for (const char* text : {"tune", "tune 3", "tune loop { rate_hz: 500 }", "tune coupling { softness: 1 }"})
        EXPECT_NE(commandProblem(text), "") << text;
}

TEST_F(CommandWords, AReplayIsLedByWords) {
    EXPECT_EQ(of("seek 12.5").replay().seek_s(), 12.5);
    EXPECT_EQ(of("speed 0.25").replay().speed(), 0.25);
    EXPECT_EQ(of("next").replay().jump(), 1);
    EXPECT_EQ(of("previous").replay().jump(), -1);
    EXPECT_EQ(of("compare 20261118T100000Z_P07_1").replay().compare_with(), "20261118T100000Z_P07_1");
    EXPECT_TRUE(of("alone").replay().has_compare_with());
    EXPECT_EQ(of("alone").replay().compare_with(), "");
    EXPECT_TRUE(of("difference").replay().shows_difference());
    EXPECT_TRUE(of("no-difference").replay().has_shows_difference());
    EXPECT_FALSE(of("no-difference").replay().shows_difference());
    EXPECT_TRUE(of("side-by-side").replay().shows_beside());
    EXPECT_FALSE(of("one-view").replay().shows_beside());
    const topics::Place place = of("when 1 -2.5  30").replay().removal_at();
    ASSERT_EQ(place.p_m_size(), 3);
    EXPECT_DOUBLE_EQ(place.p_m(0), 1e-3);
    EXPECT_DOUBLE_EQ(place.p_m(1), -2.5e-3);
    EXPECT_DOUBLE_EQ(place.p_m(2), 30e-3);
    for (const char* text : {"seek", "seek soon", "seek 1 2", "seek nan", "speed inf", "next 2", "when 1 2",
                             "when 1 2 3 4", "when a b c", "when 1 2 nan"})
        EXPECT_NE(commandProblem(text), "") << text;
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
