#include "render_client/peers/ros2_session/said_events.h"

#include <gtest/gtest.h>

#include "common/device_messages/device_state.h"

namespace bonemill::ros2 {
namespace {

using Lines = std::vector<std::string>;

TEST(SaidEvents, SayEachWarningOnceWhileItLasts) {
    SaidEvents events;
    topics::ToolState state;
    state.set_device_state(uint32_t(SafetyState::kEngaged));
    EXPECT_EQ(events.of(state), Lines{"device engaged"});
    EXPECT_EQ(events.of(state), Lines{});
    state.mutable_effects()->set_events(topics::EffectState::NEAR_PROTECTED | topics::EffectState::TOO_HOT);
    EXPECT_EQ(events.of(state), (Lines{"NEAR_PROTECTED", "TOO_HOT"}));
    EXPECT_EQ(events.of(state), Lines{});
    state.mutable_effects()->set_events(0);
    events.of(state);
    state.mutable_effects()->set_events(topics::EffectState::TOO_HOT | (1u << 31));
    EXPECT_EQ(events.of(state), Lines{"TOO_HOT"});
    state.set_device_state(uint32_t(SafetyState::kFault));
    state.set_stop_cause(uint32_t(StopCause::kPoseJump));
    EXPECT_EQ(events.of(state), Lines{"device fault: pose jumped"});
}

TEST(SaidEvents, SayHowOrdersEnded) {
    SaidEvents events;
    topics::Status status;
    EXPECT_EQ(events.of(status), Lines{});
    status.set_last_command_sender(7);
    status.set_last_command_sequence(1);
    status.set_last_command_result("only instructors");
    status.set_last_command_outcome(topics::REFUSED);
    EXPECT_EQ(events.of(status), Lines{"order refused: only instructors"});
    EXPECT_EQ(events.of(status), Lines{});
    status.set_last_command_sequence(2);
    status.set_last_command_outcome(topics::DONE);
    EXPECT_EQ(events.of(status).size(), 1u);
}

TEST(SaidEvents, KnowTheWordsOfCrtk) {
    EXPECT_STREQ(operatingStateOf(uint32_t(SafetyState::kEngaged)), "ENABLED");
    EXPECT_STREQ(operatingStateOf(uint32_t(SafetyState::kPaused)), "PAUSED");
    EXPECT_STREQ(operatingStateOf(uint32_t(SafetyState::kEmergencyStop)), "FAULT");
    EXPECT_STREQ(operatingStateOf(uint32_t(SafetyState::kReady)), "DISABLED");
    EXPECT_STREQ(operatingStateOf(4711), "DISABLED");
}

}  // namespace
}  // namespace bonemill::ros2
