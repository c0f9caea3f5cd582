#include "haptic_server/server/session/scripted_hand.h"

#include <gtest/gtest.h>

#include "tests/unit/haptic_server/server/session/session_commands_rig.h"

namespace bonemill {
namespace {

using AScriptedHand = test::SessionCommandsTest;

TEST_F(AScriptedHand, ThatHasEndedBeginsAgainOrMakesWayForTheMouse) {
    topics::Command again, take_over;
    again.set_begin_again(true);
    take_over.set_take_over(true);
    take_over.set_sender(77);
    const auto tick = [&](uint32_t flags) {
        TickRecord record{};
        record.device.flags = flags;
        ring_.tryPush(record);
        recorder_.drain();
    };
    const auto script = [&] {
        topics::Status status;
        status.mutable_device();
        commands_.describe(status);
        return status.device().script();
    };
    constexpr char kNone[] =
        "refused: no scripted hand has done all of its script (device_daemon --device simulated --hold)";
    EXPECT_EQ(order(again), kNone);
    tick(kDeviceFlagSimulated);
    EXPECT_EQ(order(again), kNone);
    EXPECT_EQ(order(take_over), kNone);
    EXPECT_EQ(script().ByteSizeLong(), 0u);
    EXPECT_FALSE(told().has_device()) << "it makes no device";

    tick(kDeviceFlagSimulated | kDeviceFlagScriptEnded);
    EXPECT_TRUE(script().has_ended());
    for (const auto& command : {again, take_over})
        for (const auto role : {topics::Viewer::VIEWER, topics::Viewer::EXAMINER})
            EXPECT_EQ(order(command, role).substr(0, 7), "refused");
    EXPECT_EQ(wanted_hands_, "");
    const uint64_t bone_order = ball_.history.newestOrder();
    ball_.history.pauseMilling(true);
    EXPECT_EQ(order(again), "done");
    EXPECT_EQ(ball_.history.newestOrder(), bone_order + 1);
    EXPECT_FALSE(ball_.history.isMillingPaused()) << "it shall mill again";
    EXPECT_EQ(wanted_hands_, "o");

    EXPECT_EQ(order(take_over), "done");
    EXPECT_EQ(wanted_hands_, "op");
    EXPECT_FALSE(script().has_ended()) << "what the old hand said last counts no more";
    EXPECT_EQ(script().taken_over_by(), 77u);
    EXPECT_EQ(order(take_over), "refused: the mouse is the hand already: hold the tool with it");
    EXPECT_EQ(order(startOf("Ann")), "done");
    EXPECT_EQ(order(again), "refused: an attempt is under way: end it, or start the next one");
    order(stop());
    EXPECT_EQ(order(again), "done") << "the script is the hand again";
    EXPECT_EQ(wanted_hands_, "opo");
    EXPECT_EQ(script().taken_over_by(), 0u);
}

}  // namespace
}  // namespace bonemill
