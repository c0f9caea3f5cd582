// A Touch or Phantom of 3D Systems through OpenHaptics HD: the library has the clock and calls us about 1000
// times a second, on a thread of its own.
//
// It gives force only, and never torque. Not verified on hardware (docs/lab/bridges.md).
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_options.h"
#include "device_daemon/bridges/touch/hd_library.h"

namespace bonemill::bridge {

// Takes the library's axes to D.
inline const Eigen::Matrix3d kTouchAxes{{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};

class TouchArm : public Arm {
  public:
    explicit TouchArm(const BridgeOptions& options) : options_(options) {}
    ~TouchArm() override { stop(); }

    ArmDescription open(const Tell& tell) override;
    void start(ArmPeriod& period) override;
    void stop() noexcept override;

  private:
    void openDevice();
    ArmDescription describe();
    // The rest is the library's thread.
    static unsigned onTick(void* arm) noexcept;
    void tick() noexcept;
    ArmReading read() noexcept;
    void readPose(ArmReading& reading) noexcept;
    void readCondition() noexcept;
    void write(const ArmOrder& order) noexcept;
    void takeErrors() noexcept;

    const BridgeOptions options_;
    std::optional<HdLibrary> hd_;
    Tell tell_;
    HdDevice device_ = kHdNoDevice;
    Eigen::Vector3d middle_V_ = Eigen::Vector3d::Zero();  // of the workspace, m
    bool has_orientation_ = false;
    unsigned long schedule_ = 0;
    bool is_scheduled_ = false;

    std::atomic<ArmPeriod*> period_{nullptr};
    std::atomic<bool> shall_end_{false};
    std::atomic<bool> has_ended_{false};  // the last tick has taken the force away

    // Of the library's thread.
    ArmReading last_;  // calibration, faults and temperature go on from tick to tick
    bool is_driving_ = false;
    unsigned error_ = 0;
    uint64_t ticks_ = 0;
};

}  // namespace bonemill::bridge
