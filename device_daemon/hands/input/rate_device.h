// What SpaceMouse and gamepad have in common: rates move a wish, the wish draws a VirtualHandle, and the
// handle feels the wrench of haptic_server.
//
// The frames are D, the device's base, and T, the handle; units are SI. The functions of HapticDevice are
// RT-safe and belong to the loop's thread; publish() and name() are for the one reading thread of the class
// that derives from this. Between the two is nothing but a Seqlock and atomics.
#pragma once

#include <atomic>
#include <string_view>

#include "common/device_messages/device_messages.h"
#include "common/rt/seqlock.h"
#include "device_daemon/hands/input/hand_input.h"
#include "device_daemon/hands/input/rate_control.h"
#include "device_daemon/hands/virtual_handle/handle_device.h"

namespace bonemill {

class RateDevice : public HapticDevice {
  public:
    DeviceCapabilities capabilities() const noexcept final;
    uint32_t capabilitiesVersion() const noexcept final { return names_ + 1; }
    bool hasClock() const noexcept final { return false; }
    bool waitForSample(int64_t) noexcept final { return false; }
    // False while nothing is plugged in; the handle rests then and no button is pressed.
    bool read(double elapsed, DeviceReading& reading) noexcept final;
    void write(const DeviceOrder& order) noexcept final;

  protected:
    // What the hand has to be told without feeling it.
    struct Felt {
        float force = 0;  // N
        uint32_t buttons = 0;
    };

    RateDevice(DeviceKind kind, std::string_view name, const RateConfig& config, const Pose& X_DT_start);

    void publish(const HandInput& input) noexcept { newest_.write(input); }
    // Takes the name of what has just been plugged in.
    void takeName(std::string_view name) noexcept;
    // Returns what is felt now; any thread.
    Felt felt() const noexcept;

  private:
    struct Name {
        char text[sizeof DeviceCapabilities::name];
    };

    void follow(double elapsed) noexcept;

    const DeviceKind kind_;
    const RateConfig config_;
    Seqlock<HandInput> newest_;
    Seqlock<Name> name_;
    std::atomic<uint32_t> names_ = 0;  // how many came
    std::atomic<float> force_ = 0;     // N on the hand
    std::atomic<uint32_t> buttons_ = 0;

    // These belong to the loop.
    VirtualHandle handle_;
    RateWish wish_;
    Wrench wrench_hand_D_;
    HandInput input_{};
    bool was_there_ = false;
};

}  // namespace bonemill
