// One period of the device loop, without processes, threads or clocks: joints -> pose -> DeviceSample, and
// WrenchCommand -> stale ramp -> limits -> actuator forces.
//
// Order per period: read() first and the sample out at once, then write() with the newest command. The
// command then answers an earlier sample, so the loop has the one tick of delay that a real device has. Time
// comes in as a parameter: the same class runs in device_daemon and in simulated time. RT-safe, one thread.
#pragma once

#include "common/device_messages/device_messages.h"
#include "common/ipc/stale_ramp.h"
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
    // `device` must outlive the loop; `start` is where forward kinematics begins to search.
    DeviceLoop(const AresKinematics& kinematics, JointDevice& device, const DeviceLoopConfig& config,
               const Pose& start) noexcept;

    // Reads the joints, `elapsed` s after the last period; the stamp is left to the caller. False: no pose
    // fits the joints, and there is nothing to publish.
    bool read(double elapsed, DeviceSample& sample) noexcept;

    // Applies the newest command (null: none yet). Commands that are not plausible count as silence.
    void write(const WrenchCommand* newest, int64_t now_ns) noexcept;

    // From now on every command is ignored and the force ramps to zero; isReleased() says that it arrived
    // there.
    void release() noexcept { is_releasing_ = true; }
    bool isReleased() const noexcept { return is_releasing_ && ramp_.factor() == 0; }

    bool isPeerStale() const noexcept { return ramp_.isStale(); }
    const Pose& pose() const noexcept { return X_DT_; }                           // last solved handle pose
    const Vector6d& actuatorForces() const noexcept { return actuator_forces_; }  // last applied
    const Wrench& appliedWrench() const noexcept {
        return applied_wrench_;
    }  // what those forces make, on the hand, D
    uint32_t limitEvents() const noexcept { return limiter_.events(); }  // ForceLimitEvent, last write()
    uint64_t failedPoses() const noexcept { return failed_poses_; }      // read() that returned false

  private:
    AresKinematics kinematics_;
    JointDevice& device_;
    DeviceLoopConfig config_;
    StaleRamp ramp_;
    ForceLimiter limiter_;
    Pose X_DT_;
    bool has_pose_ = false;    // the last read() succeeded
    double elapsed_ = 0;       // s, of the last read()
    WrenchCommand command_{};  // last plausible one
    bool has_command_ = false;
    bool is_releasing_ = false;
    Vector6d actuator_forces_ = Vector6d::Zero();
    Wrench applied_wrench_;
    uint64_t failed_poses_ = 0;
};

}  // namespace bonemill
