// A gamepad as the hand: device_daemon --device gamepad. its motors shake with force and cutting where it has
// any.
//
// The thread rules are those of RateDevice.
#pragma once

#include <cstdint>
#include <string>

#include "device_daemon/hands/input/evdev_device.h"
#include "device_daemon/hands/input/input_reader.h"
#include "device_daemon/hands/input/rate_device.h"

namespace bonemill {

// Makes a gamepad's motors shake with what its user cannot feel: the strong one with the force, the weak one
// while the burr turns, and more with the force.
struct RumbleLevel {
    uint16_t strong = 0;
    uint16_t weak = 0;

    bool operator==(const RumbleLevel&) const = default;
};

// The force is that on the hand in N; the level is full at RumbleMotors::kFullForce.
RumbleLevel rumbleOf(double force, bool is_cutting) noexcept;

class RumbleMotors {
  public:
    static constexpr double kFullForce = 8;   // N
    static constexpr double kMinForce = 0.3;  // N; below it the strong motor rests

    RumbleMotors() = default;
    // The file is that of an input device with FF_RUMBLE, open for writing.
    explicit RumbleMotors(int file) noexcept : file_(file) {}

    // Not for the loop. Shakes like that until told otherwise, for kEffectMs at most. It is called every
    // InputReader::kRest.
    void shake(const RumbleLevel& level) noexcept;

  private:
    static constexpr uint16_t kEffectMs = 500;  // how long the motors run on if this program dies
    static constexpr int64_t kRefreshNs = 250'000'000;

    int file_ = -1;
    int effect_ = -1;  // the kernel's number of it
    RumbleLevel level_;
    int64_t started_ns_ = 0;
};

// What the sticks and buttons of a gamepad mean.
//
//   left stick          moves the tool right, left, up and down in the picture
//   right, left trigger push it into the picture, and pull it out
//   right stick         turns it about the picture's upright and level axes
//   cross left, right   rolls it about the line of sight
//   A (south), B (east) remove, add
//   left shoulder       slow, while held
//
// The names are those of the kernel's gamepad specification, which its drivers follow. Gamepads without a
// driver of their own have the right stick where others have the triggers, and the triggers as buttons.
HandInput handInputOf(const EvdevState& state) noexcept;

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
