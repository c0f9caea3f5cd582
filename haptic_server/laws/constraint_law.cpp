#include "haptic_server/laws/constraint_law.h"

namespace bonemill {
namespace {

// The coupling's stiffness about the tool point, unsaturated: its force acts at the grip.
Matrix6d stiffnessOf(const EnergyCoupling& coupling, const Pose& X_VT) noexcept {
    Eigen::Matrix<double, 3, 6> at_grip;
    at_grip << Eigen::Matrix3d::Identity(), -skew(X_VT.rotation * coupling.p_TG);
    Matrix6d K = coupling.translation_stiffness * at_grip.transpose() * at_grip;
    K.bottomRightCorner<3, 3>().diagonal().array() += coupling.rotation_stiffness;
    return K;
}

}  // namespace

SpoStep ConstraintLaw::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    SpoStep step;
    const BlockedMotion::Wish wish{.X_VT = X_VT_device,
                                   .K = stiffnessOf(coupling(), X_VT),
                                   .may_turn = true,
                                   .rounds = iterations(),
                                   .recovery = BlockedMotion::kRecovery * dt(),
                                   .bite = bite(),
                                   .most_move = config().steps.max_speed * dt(),
                                   .most_turn = config().steps.max_angular_speed * dt()};
    Pose tool = X_VT;
    const Vector6d reaction = motion_.go(world(), level(), field(), wish, tool, step);
    reaction_ = {reaction.head<3>(), reaction.tail<3>()};
    feel(step, tool, X_VT_device);
    return step;
}

}  // namespace bonemill
