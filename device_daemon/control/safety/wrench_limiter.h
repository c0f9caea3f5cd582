// What the hand may be told to feel, whatever was commanded: all limits on the wrench, in this order.
//
// 1. Finite. What is not a number can be compared with no limit: it counts as zero.
// 2. The rate: force and torque change by no more than their rates allow. From a demand far beyond the norms
//    they come back at once, because the rate counts from what was given.
// 3. The norms: force and torque are each scaled to what the device can give. Scaling keeps the direction,
//    and since it goes to a convex ball, it never lengthens the step that the rate has allowed.
// 4. The factor of engaging, pausing, stopping and of hot motors. It comes last, so that no other limit can
//    undo it.
//
// Force and torque are limited apart from each other: a torque that a device cannot give takes nothing of the
// force. It is RT-safe, for one thread. Units are N, N·m, s; the frame is the caller's.
#pragma once

#include <cstdint>

#include "common/geometry/pose.h"

namespace bonemill {

struct WrenchLimits {
    double max_force = 50;         // N
    double max_torque = 1;         // N·m
    double max_force_rate = 3000;  // N/s
    double max_torque_rate = 60;   // N·m/s
};

// Says what the limiter did (bit mask).
enum WrenchLimitEvent : uint32_t {
    kWrenchNotLimited = 0,
    kWrenchNotFinite = 1u << 0,
    kWrenchRateLimited = 1u << 1,
    kWrenchClamped = 1u << 2,
};

class WrenchLimiter {
  public:
    explicit WrenchLimiter(const WrenchLimits& limits = {}) noexcept : limits_(limits) {}

    // Another device gives other norms.
    void setLimits(const WrenchLimits& limits) noexcept { limits_ = limits; }

    // Called once per period, dt after the last call, it returns what may be given of `wanted`: always
    // finite, and within the limits. `factor` is 0 to 1.
    Wrench limit(const Wrench& wanted, double factor, double dt) noexcept;

    uint32_t events() const noexcept { return events_; }  // WrenchLimitEvent bits of the last call

  private:
    void approach(const Eigen::Vector3d& wanted, double most, Eigen::Vector3d& value) noexcept;

    WrenchLimits limits_;
    Wrench before_factor_;
    uint32_t events_ = kWrenchNotLimited;
};

}  // namespace bonemill
