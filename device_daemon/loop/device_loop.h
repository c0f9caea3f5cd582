// This is one period of the device loop, without processes, threads or clocks: joints -> pose ->
// DeviceSample, and WrenchCommand -> limits -> actuator forces. The limits, and their order,
// stand in safety/force_limiter.h.
//
// In a period read() comes first, and the sample goes out at once; then write() takes the newest command.
// The command so answers an earlier sample, and the loop has the one tick of delay that a real device has.
// Time comes in as a parameter: the same class runs in device_daemon and in simulated time. It is RT-safe,
// for one thread.
#pragma once

#include "common/device_messages/device_messages.h"
#include "device_daemon/driver/joint_device.h"
#include "device_daemon/safety/force_limiter.h"

namespace bonemill {

struct DeviceLoopConfig {
    ForceLimits limits;
    StaleRampConfig stale;
    uint32_t sample_flags = 0;  // DeviceFlag bits that every sample carries
};

class DeviceLoop {
  public:
    // `device` must outlive the loop; `X_DT_start` is where forward kinematics begins to search.
    DeviceLoop(const AresKinematics& kinematics, JointDevice& device, const DeviceLoopConfig& config,
               const Pose& X_DT_start) noexcept;

    // Reads the joints, `elapsed` s after the last period; the stamp is left to the caller. False says that
    // no pose fits the joints, and there is nothing to publish.
    bool read(double elapsed, DeviceSample& sample) noexcept;

    // Applies the newest command, or null if there is none yet. What is not plausible counts as silence.
    void write(const WrenchCommand* newest, int64_t now_ns) noexcept;

    // From now on every command is ignored and the force ramps to zero; isReleased() says that
    // it arrived there.
    void release() noexcept { limiter_.release(); }
    bool isReleased() const noexcept { return limiter_.isReleased(); }

    bool isPeerStale() const noexcept { return limiter_.isStale(); }
    // Returns the handle's pose that was last found.
    const Pose& pose() const noexcept { return X_DT_; }
    // Return the forces last applied, and the wrench on the hand that they make, in D.
    const Vector6d& actuatorForces() const noexcept { return actuator_forces_; }
    const Wrench& appliedWrench() const noexcept { return applied_wrench_; }
    // Returns the ForceLimitEvent bits of the last write().
    uint32_t limitEvents() const noexcept { return limiter_.events(); }
    // Tells how often read() returned false.
    uint64_t failedPoses() const noexcept { return failed_poses_; }

  private:
    AresKinematics kinematics_;
    JointDevice& device_;
    uint32_t sample_flags_;
    ForceLimiter limiter_;
    Pose X_DT_;
    bool has_pose_ = false;  // the last read() succeeded
    double elapsed_ = 0;     // s, of the last read()
    Vector6d actuator_forces_ = Vector6d::Zero();
    Wrench applied_wrench_;
    uint64_t failed_poses_ = 0;
};

}  // namespace bonemill
