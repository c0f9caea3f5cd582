// Sticks, triggers and buttons mean what gamepad_device.h says, with a driver of its own and without.
#include <gtest/gtest.h>

#include "common/device_messages/device_messages.h"
#include "device_daemon/hands/input/gamepad_device.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

enum Deflection { kRight, kUp, kTowardsUser, kPitch, kYaw, kRoll };

TEST(GamepadMap, AtRestNothingIsWanted) {
    const HandInput input = handInputOf(test::padState());
    for (const float deflection : input.deflections) EXPECT_NEAR(deflection, 0, 1e-4);
    EXPECT_EQ(input.buttons, 0u);
    EXPECT_FALSE(input.is_fine);
    EXPECT_TRUE(input.is_there);
}

TEST(GamepadMap, LeftStickMovesInThePictureAndTriggersInDepth) {
    EvdevState state = test::padState();
    state.axes[ABS_X].value = 32767;
    state.axes[ABS_Y].value = -32768;  // pushed away from the user
    state.axes[ABS_RZ].value = 255;    // right trigger
    const HandInput input = handInputOf(state);
    EXPECT_FLOAT_EQ(input.deflections[kRight], 1);
    EXPECT_FLOAT_EQ(input.deflections[kUp], 1);
    EXPECT_FLOAT_EQ(input.deflections[kTowardsUser], -1);
    state.axes[ABS_Z].value = 255;
    EXPECT_FLOAT_EQ(handInputOf(state).deflections[kTowardsUser], 0);
}

TEST(GamepadMap, RightStickAndCrossTurn) {
    EvdevState state = test::padState();
    state.axes[ABS_RX].value = 32767;
    state.axes[ABS_RY].value = 32767;
    state.axes[ABS_HAT0X].value = 1;
    const HandInput input = handInputOf(state);
    EXPECT_FLOAT_EQ(input.deflections[kPitch], 1);
    EXPECT_FLOAT_EQ(input.deflections[kYaw], 1);
    EXPECT_FLOAT_EQ(input.deflections[kRoll], -1);  // clockwise as the user sees it
}

TEST(GamepadMap, ButtonsRemoveAddAndSlowDown) {
    EvdevState state = test::padState();
    state.keys.set(BTN_SOUTH);
    EXPECT_EQ(handInputOf(state).buttons, kButtonRemove);
    state.keys.set(BTN_EAST).set(BTN_TL);
    EXPECT_EQ(handInputOf(state).buttons, kButtonRemove | kButtonAdd);
    EXPECT_TRUE(handInputOf(state).is_fine);
}

TEST(GamepadMap, WithoutADriverOfItsOwnTheRightStickIsZAndRz) {
    EvdevState state;
    for (const int axis : {ABS_X, ABS_Y, ABS_Z, ABS_RZ})
        state.axes[axis] = {.value = 128, .min = 0, .max = 255};
    EXPECT_NEAR(handInputOf(state).deflections[kTowardsUser], 0, 1e-6);
    state.axes[ABS_Z].value = 255;
    state.axes[ABS_RZ].value = 0;
    state.keys.set(BTN_TL2);
    const HandInput input = handInputOf(state);
    EXPECT_FLOAT_EQ(input.deflections[kYaw], 1);
    EXPECT_FLOAT_EQ(input.deflections[kPitch], -1);
    EXPECT_FLOAT_EQ(input.deflections[kTowardsUser], 1);
}

}  // namespace
}  // namespace bonemill
