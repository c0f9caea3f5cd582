#include "device_daemon/loop/device_loop.h"

namespace bonemill {

DeviceLoop::DeviceLoop(const AresKinematics& kinematics, JointDevice& device, const DeviceLoopConfig& config,
                       const Pose& X_DT_start) noexcept
    : kinematics_(kinematics),
      device_(device),
      sample_flags_(config.sample_flags),
      limiter_(config.limits, config.stale),
      X_DT_(X_DT_start) {}

bool DeviceLoop::read(double elapsed, DeviceSample& sample) noexcept {
    elapsed_ = elapsed;
    JointReading joints;
    const bool is_heard = device_.readJoints(elapsed, joints);
    const ForwardSolution solution = kinematics_.forward(joints.q, X_DT_);
    has_pose_ = is_heard && solution.converged;
    if (!has_pose_) {
        ++failed_poses_;
        return false;
    }
    X_DT_ = solution.X_DT;

    sample = {};
    Eigen::Map<Eigen::Vector3d>(sample.p_DT) = X_DT_.position;
    const Eigen::Quaterniond& q = X_DT_.rotation;
    Eigen::Map<Eigen::Vector4d>(sample.q_DT) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
    sample.buttons = joints.buttons;
    sample.flags = sample_flags_;
    if (limiter_.events() != kForceNotLimited) sample.flags |= kDeviceFlagForceLimited;
    return true;
}

void DeviceLoop::write(const WrenchCommand* newest, int64_t now_ns) noexcept {
    if (newest && isPlausible(*newest)) {
        limiter_.take({Eigen::Map<const Eigen::Vector3d>(newest->f_hand_D),
                       Eigen::Map<const Eigen::Vector3d>(newest->t_hand_D)},
                      newest->stamp_ns);
    }
    Matrix6d J_inv;
    const bool is_usable = has_pose_ && kinematics_.inverseJacobian(X_DT_, J_inv);
    actuator_forces_ = limiter_.forces(is_usable ? &J_inv : nullptr, now_ns, elapsed_);
    applied_wrench_ = is_usable ? wrenchOf(J_inv, actuator_forces_) : Wrench{};  // unknown without a pose
    device_.applyForces({.forces = actuator_forces_, .is_wanted = true, .is_engaged = true});
}

}  // namespace bonemill
