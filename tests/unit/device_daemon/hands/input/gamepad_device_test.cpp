// Gamepad and pedal are heard through pipes that speak like the kernel's input files.
#include "device_daemon/hands/input/gamepad_device.h"

#include <gtest/gtest.h>

#include "device_daemon/hands/input/pedal_source.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

using test::comesTrue;
using test::PipedInput;

class GamepadDeviceTest : public testing::Test {
  protected:
    bool isThere() { return device.read(0, reading); }
    bool isPressed(uint32_t buttons) { return isThere() && reading.buttons == buttons; }
    void run(double seconds) {
        for (int i = 0; i < seconds * 1000; ++i) device.read(1e-3, reading);
    }

    PipedInput pad;
    GamepadDevice device{RateConfig{}, Pose{}, pad.opener()};
    DeviceReading reading;
};

TEST_F(GamepadDeviceTest, MovesTheHandle) {
    EXPECT_FALSE(isThere());
    pad.plugIn();
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    EXPECT_STREQ(device.capabilities().name, "piped pad");
    pad.send(EV_ABS, ABS_X, 32767);
    pad.send(EV_KEY, BTN_SOUTH, 1);
    ASSERT_TRUE(comesTrue([&] { return isPressed(kButtonRemove); }));
    run(1);
    EXPECT_NEAR(reading.v_DT.x(), RateConfig{}.max_speed, 0.001);
}

TEST_F(GamepadDeviceTest, UnpluggedItIsLostAndPluggedInAgainItGoesOn) {
    pad.plugIn();
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    const uint32_t version = device.capabilitiesVersion();
    pad.send(EV_ABS, ABS_X, 32767);
    pad.send(EV_KEY, BTN_SOUTH, 1);
    ASSERT_TRUE(comesTrue([&] { return isPressed(kButtonRemove); }));
    pad.unplug();
    ASSERT_TRUE(comesTrue([&] { return !isThere(); }));
    EXPECT_EQ(reading.buttons, 0u);
    run(1);
    EXPECT_LT(reading.v_DT.norm(), 1e-6);
    pad.plugIn();
    ASSERT_TRUE(comesTrue([&] { return isPressed(0); }));
    EXPECT_NE(device.capabilitiesVersion(), version);
    run(1);
    EXPECT_LT(reading.v_DT.norm(), 1e-6);
}

TEST_F(GamepadDeviceTest, DroppedEventsThatCannotBeAskedForAreALostDevice) {
    pad.plugIn();
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    pad.send(EV_SYN, SYN_DROPPED, 0);
    EXPECT_TRUE(comesTrue([&] { return !isThere(); }));
}

TEST(PedalSource, AnyKeyRemovesAndUnpluggedItIsReleased) {
    PipedInput pipe{EvdevState{}};
    const PedalSource pedal(pipe.opener());
    EXPECT_FALSE(pedal.isThere());
    pipe.plugIn();
    ASSERT_TRUE(comesTrue([&] { return pedal.isThere(); }));
    EXPECT_EQ(pedal.buttons(), 0u);
    pipe.send(EV_KEY, KEY_B, 1);
    ASSERT_TRUE(comesTrue([&] { return pedal.buttons() == kButtonRemove; }));
    pipe.send(EV_KEY, KEY_B, 0);
    ASSERT_TRUE(comesTrue([&] { return pedal.buttons() == 0; }));
    pipe.send(EV_KEY, KEY_B, 1);
    ASSERT_TRUE(comesTrue([&] { return pedal.buttons() == kButtonRemove; }));
    pipe.unplug();
    EXPECT_TRUE(comesTrue([&] { return pedal.buttons() == 0 && !pedal.isThere(); }));
    pipe.plugIn();
    EXPECT_TRUE(comesTrue([&] { return pedal.isThere(); }));
}

TEST(EvdevDevice, WhatIsNoInputDeviceIsRefused) {
    EXPECT_FALSE(openEvdev("/dev/null", false));
    EXPECT_FALSE(openEvdev("/nowhere", false));
    EXPECT_FALSE(gamepadAt("/dev/null")());
}

TEST(Rumble, GrowsWithTheForceAndPurrsWhileTheBurrTurns) {
    EXPECT_EQ(rumbleOf(0, false), RumbleLevel{});
    EXPECT_EQ(rumbleOf(0.1, false), RumbleLevel{});
    const RumbleLevel turning = rumbleOf(0, true);
    EXPECT_EQ(turning.strong, 0);
    EXPECT_GT(turning.weak, 0);
    EXPECT_LT(rumbleOf(2, false).strong, rumbleOf(6, false).strong);
    EXPECT_EQ(rumbleOf(2, false).weak, 0);
    EXPECT_GT(rumbleOf(4, true).weak, turning.weak);
    EXPECT_GT(rumbleOf(1000, true).strong, 0xf000);
    EXPECT_EQ(rumbleOf(std::numeric_limits<double>::quiet_NaN(), false), RumbleLevel{});
}

}  // namespace
}  // namespace bonemill
