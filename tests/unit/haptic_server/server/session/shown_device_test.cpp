#include <gtest/gtest.h>

#include <cstring>

#include "haptic_server/server/session/shown_effects.h"

namespace bonemill {
namespace {

DeviceCapabilities touch() {
    return {.name = "Touch",
            .kind = uint32_t(DeviceKind::kTouch),
            .abilities = kAbilityForce | kAbilityOrientation,
            .max_force = 3.3,
            .max_torque = 0,
            .max_stiffness = 0,
            .max_rotation_stiffness = 0,
            .workspace_radius = 0.08};
}

TEST(ShownDevice, HasWhatSampleAndCapabilitiesSay) {
    TickRecord record{};
    record.device = {uint32_t(SafetyState::kReady), uint32_t(StopCause::kSpeed), 0,
                     kDeviceFlagSimulated | kDeviceFlagForceWaits};
    record.coupling_share = 0.4;
    record.rotation_share = 0.03;
    const DeviceReport& status = record.device;
    const DeviceCapabilities capabilities = touch();
    const topics::Device device = shownDevice(record, &capabilities);
    EXPECT_EQ(device.name(), "Touch");
    EXPECT_EQ(device.kind(), uint32_t(DeviceKind::kTouch));
    EXPECT_EQ(device.state(), status.state);
    EXPECT_EQ(device.stop_cause(), status.stop_cause);
    EXPECT_TRUE(device.is_simulated() && device.force_waits());
    EXPECT_FALSE(device.is_enabled() || device.is_force_limited());
    EXPECT_EQ(device.abilities(), capabilities.abilities);
    EXPECT_EQ(device.max_force_n(), 3.3);
    EXPECT_EQ(device.coupling_share(), 0.4);
    EXPECT_EQ(device.rotation_share(), 0.03);
    EXPECT_EQ(shownDevice(record, nullptr).name(), "");
    EXPECT_EQ(shownDevice(record, nullptr).state(), status.state);
}

// The text and the figures come from another process and go to all viewers.
TEST(ShownDevice, GarbageThatIsPlausibleIsShownHarmlessly) {
    DeviceCapabilities odd = touch();
    std::memcpy(odd.name, "a\n\xff\x1b[2Jb", 9);
    odd.max_force = odd.max_torque = 1e6;
    ASSERT_TRUE(isPlausible(odd));
    const topics::Device device = shownDevice(TickRecord{}, &odd);
    EXPECT_EQ(device.name(), "a???[2Jb");
    EXPECT_LE(device.max_force_n(), 1e6);
    EXPECT_LE(device.max_torque_nmm(), 1e6);
}

TEST(ShownDevice, IsToldInWords) {
    DeviceCapabilities device = touch();
    EXPECT_EQ(deviceText(device), "Touch: 3.3 N, no torque");
    device.abilities = kAbilityTorque;
    device.max_torque = 0.4;
    EXPECT_EQ(deviceText(device), "Touch: no force, 400 N\u00b7mm");
}

}  // namespace
}  // namespace bonemill
