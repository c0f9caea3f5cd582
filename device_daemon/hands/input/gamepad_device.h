// A gamepad as the hand: device_daemon --device gamepad. gamepad_map.h says what its sticks do; its motors
// shake with force and cutting where it has any.
//
// The thread rules are those of RateDevice.
#pragma once

#include <string>

#include "device_daemon/hands/input/evdev_device.h"
#include "device_daemon/hands/input/input_reader.h"
#include "device_daemon/hands/input/rate_device.h"
#include "device_daemon/hands/input/rumble.h"

namespace bonemill {

// Opens /dev/input/event*; without a path the first gamepad that may be read.
EvdevOpener gamepadAt(const std::string& path = {});

class GamepadDevice final : public RateDevice, private InputSource {
  public:
    // Nothing need be there yet.
    GamepadDevice(const RateConfig& config, const Pose& X_DT_start, EvdevOpener opener = gamepadAt());

  private:
    int open() override;
    bool take(std::span<const std::byte> bytes) override;
    bool rest() override;
    void lost() override;

    const EvdevOpener opener_;

    // These belong to the reading thread.
    int file_ = -1;
    EvdevStream stream_;
    RumbleMotors motors_;

    InputReader reader_;
};

}  // namespace bonemill
