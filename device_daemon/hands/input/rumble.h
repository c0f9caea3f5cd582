// Makes a gamepad's motors shake with what its user cannot feel: the strong one with the force, the weak one
// while the burr turns, and more with the force.
//
// It makes system calls and is not for the loop.
#pragma once

#include <cstdint>

namespace bonemill {

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

    // Shakes like that until told otherwise, for kEffectMs at most. It is called every InputReader::kRest.
    void shake(const RumbleLevel& level) noexcept;

  private:
    static constexpr uint16_t kEffectMs = 500;  // how long the motors run on if this program dies
    static constexpr int64_t kRefreshNs = 250'000'000;

    int file_ = -1;
    int effect_ = -1;  // the kernel's number of it
    RumbleLevel level_;
    int64_t started_ns_ = 0;
};

}  // namespace bonemill
