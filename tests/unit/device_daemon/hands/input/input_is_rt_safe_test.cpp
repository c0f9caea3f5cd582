// A period with a SpaceMouse, a gamepad and a pedal allocates nothing and takes no lock, while their threads
// read.
#include <gtest/gtest.h>

#include "device_daemon/hands/input/gamepad_device.h"
#include "device_daemon/hands/input/pedal_source.h"
#include "device_daemon/hands/input/spacemouse_device.h"
#include "tests/support/rt_guard/rt_probe.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

uint32_t periodOf(HapticDevice& device, const DeviceOrder& order) {
    DeviceReading reading;
    device.read(1e-3, reading);
    device.write(order);
    device.waitForSample(0);
    return device.capabilitiesVersion() + device.capabilities().kind + reading.buttons;
}

TEST(InputIsRtSafe, InAPeriodOfTheLoop) {
    const test::TemporaryFolder folder;
    const test::FakeSpacenavd spacenavd(folder / "spnav.sock", 1, true);
    test::PipedInput pad, pedal_pipe;
    SpaceMouseDevice mouse(RateConfig{}, Pose{}, folder / "spnav.sock");
    GamepadDevice gamepad(RateConfig{}, Pose{}, pad.opener());
    const PedalSource pedal(pedal_pipe.opener());
    pad.plugIn();
    pedal_pipe.plugIn();
    DeviceReading reading;
    ASSERT_TRUE(test::comesTrue(
        [&] { return mouse.read(0, reading) && gamepad.read(0, reading) && pedal.isThere(); }));

    const DeviceOrder order{
        .wrench_hand_D = {{1, 2, 3}, {0.01, 0, 0}}, .is_wanted = true, .is_engaged = true};
    uint32_t sum = 0;
    for (int i = 0; i < 300; ++i) {
        spacenavd.send({0, i, -i, i, 0, 0, i, 1});
        pad.send(EV_ABS, ABS_X, 100 * i);
        pedal_pipe.send(EV_KEY, KEY_A, i % 2);
        if (i == 200) pad.unplug();
        RtProbe probe;
        sum += periodOf(mouse, order) + periodOf(gamepad, order) + pedal.buttons();
        probe.stop();
        ASSERT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
        ASSERT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
        if (i == 200) pad.plugIn();
    }
    EXPECT_GT(sum, 0u);
}

}  // namespace
}  // namespace bonemill
