// A haptic device whose reading a test sets, and which remembers what it was ordered.
#pragma once

#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill::test {

class FakeDevice final : public HapticDevice {
  public:
    FakeDevice() {
        std::copy_n("fake", 5, device.name);
        device.abilities = kAbilityForce | kAbilityTorque | kAbilityOrientation | kAbilityEnablingSwitch;
        device.max_force = 20;
        device.max_torque = 0.5;
        reading.status = kStatusPowered | kStatusCalibrated;
    }

    DeviceCapabilities capabilities() const noexcept override { return device; }
    uint32_t capabilitiesVersion() const noexcept override { return version; }
    bool hasClock() const noexcept override { return false; }
    bool waitForSample(int64_t) noexcept override { return false; }
    // As long as it is wanted and nothing is wrong it drives.
    bool read(double, DeviceReading& newest) noexcept override {
        newest = reading;
        if (order.is_wanted && (reading.status & kStatusPowered)) newest.status |= kStatusDriving;
        if (measures_force) {
            newest.has_applied = true;
            newest.applied_D = is_amplifier_dead ? Wrench{} : order.wrench_hand_D;
        }
        return is_heard;
    }
    void write(const DeviceOrder& newest) noexcept override {
        order = newest;
        if (order.reset && clears_fault_on_reset) reading.fault = StopCause::kNone;
    }

    DeviceCapabilities device{};
    uint32_t version = 1;
    DeviceReading reading;
    bool is_heard = true;
    bool measures_force = false;
    bool is_amplifier_dead = false;
    bool clears_fault_on_reset = false;
    DeviceOrder order;
};

}  // namespace bonemill::test
