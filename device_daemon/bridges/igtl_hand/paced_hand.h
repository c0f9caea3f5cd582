// Makes a reading of every period out of poses that come more seldom, and not evenly: the hand moves from
// where it was to where it was said to be within the time that poses take to come, and never jumps of itself.
// So it is late by one pose of the peer.
//
// It is RT-safe, for one thread.
#pragma once

#include <algorithm>

#include "common/base/units.h"
#include "device_daemon/bridges/bridge/arm.h"

namespace bonemill::bridge {

// What the port heard last. Of trivial parts, for a Seqlock; stamps are CLOCK_MONOTONIC ns.
struct HeardPose {
    std::array<double, 3> p_D{};  // m
    std::array<double, 4> q_D{1, 0, 0, 0};
    int64_t heard_ns = 0;
    uint64_t count = 0;    // of poses
    uint64_t hold = 0;     // another hand holds it than before
    uint32_t buttons = 0;  // Button bits
    bool is_held = false;
};

class PacedHand {
  public:
    // Without a pose for so long the arm has not said where it is.
    static constexpr int64_t kFreshNs = 25 * kNsPerMillisecond;
    // A hand that was let go is in fault for so long, then waits for the next one.
    static constexpr int64_t kLostNs = kNsPerSecond;

    ArmReading step(const HeardPose& heard, int64_t now_ns) noexcept;

  private:
    static Pose poseOf(const HeardPose& heard) noexcept {
        return {Eigen::Vector3d(heard.p_D.data()),
                Eigen::Quaterniond(heard.q_D[0], heard.q_D[1], heard.q_D[2], heard.q_D[3])};
    }
    void aim(const HeardPose& heard, int64_t now_ns) noexcept;
    Pose poseAt(int64_t now_ns) const noexcept;

    Pose from_, to_;
    int64_t aimed_ns_ = 0;  // at `to_`, from `from_`
    double pace_ns_ = 10e6;
    uint64_t count_ = 0, hold_ = 0;
    int64_t heard_ns_ = 0;
};

inline Pose PacedHand::poseAt(int64_t now_ns) const noexcept {
    const double part = std::clamp(double(now_ns - aimed_ns_) / pace_ns_, 0.0, 1.0);
    return {from_.position + part * (to_.position - from_.position),
            from_.rotation.slerp(part, to_.rotation)};
}

inline void PacedHand::aim(const HeardPose& heard, int64_t now_ns) noexcept {
    constexpr double kShare = 0.1, kFastestNs = 1e6, kSlowestNs = 20e6;
    const bool is_first = heard.hold != hold_;
    if (!is_first) {
        const double poses = double(heard.count - count_);
        const double passed_ns = double(heard.heard_ns - heard_ns_) / std::max(poses, 1.0);
        pace_ns_ = std::clamp(pace_ns_ + kShare * (passed_ns - pace_ns_), kFastestNs, kSlowestNs);
    }
    from_ = is_first ? poseOf(heard) : poseAt(now_ns);
    to_ = poseOf(heard);
    aimed_ns_ = now_ns;
    count_ = heard.count;
    hold_ = heard.hold;
    heard_ns_ = heard.heard_ns;
}

inline ArmReading PacedHand::step(const HeardPose& heard, int64_t now_ns) noexcept {
    if (heard.is_held && heard.count != count_) aim(heard, now_ns);
    ArmReading reading;
    const bool is_fresh = heard.is_held && now_ns - heard_ns_ <= kFreshNs;
    const bool has_been_lost = !is_fresh && hold_ != 0 && now_ns - heard_ns_ < kLostNs;
    // Before the first hand, and once the loss of one was told, the arm is there and does not know where it
    // is.
    reading.is_valid = !has_been_lost;
    reading.is_homed = reading.is_powered = is_fresh;
    reading.buttons = is_fresh ? heard.buttons : 0;
    reading.X_DT = poseAt(now_ns);
    return reading;
}

}  // namespace bonemill::bridge
