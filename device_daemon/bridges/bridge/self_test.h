// Measures an arm without device_daemon: how often and how evenly it has its periods, and, if asked, whether
// it pushes up with a small force and back.
//
// step() runs on the arm's thread; lines() is for after it has stopped.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/rt/latency_histogram.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/force_gate.h"

namespace bonemill::bridge {

class SelfTest : public ArmPeriod {
  public:
    SelfTest(const ArmDescription& arm, double seconds, bool has_ramp);

    ArmOrder step(const ArmReading& reading, int64_t now_ns) noexcept override;
    bool hasEnded() const noexcept { return has_ended_; }
    // Asks for the end: the force fades. Whoever calls it before the time has passed gets "failed".
    void leave() noexcept { shall_leave_ = true; }
    int64_t lastStepNs() const noexcept { return before_ns_; }
    // Says what was measured; the first line is "passed" or what failed.
    std::vector<std::string> lines() const;

    static constexpr double kRampForce = 0.5;  // N, along D's z: up
    static constexpr double kRampTime = 2;     // s, up and down

  private:
    Wrench ramp(const ArmReading& reading, double time) noexcept;

    const double seconds_;
    const bool has_ramp_;
    ForceGate gate_;
    int64_t start_ns_ = 0;
    std::atomic<int64_t> before_ns_{0};
    std::atomic<bool> has_ended_{false};
    std::atomic<bool> shall_leave_{false};
    uint64_t periods_ = 0, invalid_ = 0, failed_ = 0;
    bool was_homed_ = false;
    bool has_pushed_ = false;
    Eigen::Vector3d lowest_ = Eigen::Vector3d::Zero(), highest_ = Eigen::Vector3d::Zero();
    LatencyHistogram intervals_;
};

}  // namespace bonemill::bridge
