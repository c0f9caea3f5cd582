#include "device_daemon/loop/device_loop.h"

namespace bonemill {

DeviceLoop::DeviceLoop(const AresKinematics& kinematics, JointDevice& device, const DeviceLoopConfig& config,
                       const Pose& start) noexcept
    : kinematics_(kinematics),
      device_(device),
      config_(config),
      ramp_(config.stale),
      limiter_(config.limits),
      X_DT_(start) {}

bool DeviceLoop::read(double elapsed, DeviceSample& sample) noexcept {
    elapsed_ = elapsed;
    const JointReading joints = device_.readJoints(elapsed);
    const ForwardSolution solution = kinematics_.forward(joints.q, X_DT_);
    has_pose_ = solution.converged;
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
    sample.flags = config_.sample_flags;
    if (limiter_.events() != kForceNotLimited) sample.flags |= kDeviceFlagForceLimited;
    return true;
}

void DeviceLoop::write(const WrenchCommand* newest, int64_t now_ns) noexcept {
    if (newest && isPlausible(*newest)) {
        command_ = *newest;
        has_command_ = true;
    }
    const int64_t long_ago_ns = now_ns - 2 * config_.stale.stale_after_ns - 1;
    const double factor =
        ramp_.update(now_ns, has_command_ && !is_releasing_ ? command_.stamp_ns : long_ago_ns);

    Matrix6d J_inv;
    if (has_pose_ && kinematics_.inverseJacobian(X_DT_, J_inv)) {
        const Wrench wrench{factor * Eigen::Map<const Eigen::Vector3d>(command_.f_hand_D),
                            factor * Eigen::Map<const Eigen::Vector3d>(command_.t_hand_D)};
        actuator_forces_ = limiter_.limit(wrench, J_inv, elapsed_);
        applied_wrench_ = wrenchOf(J_inv, actuator_forces_);
    } else {
        actuator_forces_ = limiter_.fadeOut(elapsed_);
        applied_wrench_ = {};  // unknown without a pose
    }
    device_.applyForces(actuator_forces_);
}

}  // namespace bonemill
