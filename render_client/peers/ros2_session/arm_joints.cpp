#include "render_client/peers/ros2_session/arm_joints.h"

#include "common/ares_kinematics/scene_ares.h"

namespace bonemill::ros2 {

AresArm::AresArm(const scene::Device& device, const Pose& X_WD)
    : kinematics_(aresGeometryOf(device)),
      is_buildable_(kinematics_.isBuildable()),
      hand_space_(device.workspace_scale()),
      X_DW_(X_WD.inverse()) {}

std::optional<ArmJoints> AresArm::jointsAt(const Pose& X_WT, const std::optional<Motion>& motion) const {
    const Pose X_DT = hand_space_.poseAtHand(X_DW_ * X_WT);
    ArmJoints joints;
    if (!is_buildable_ || !kinematics_.inverse(X_DT, joints.positions)) return std::nullopt;
    Matrix6d J_inv;
    if (!motion || !kinematics_.inverseJacobian(X_DT, J_inv)) return joints;
    Vector6d twist_D;
    twist_D << X_DW_.rotation * hand_space_.wayAtHand(motion->v_WT), X_DW_.rotation * motion->w_WT;
    joints.velocities = J_inv * twist_D;
    return joints;
}

}  // namespace bonemill::ros2
