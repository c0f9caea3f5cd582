#include "haptic_server/spo/thesis_2012_model.h"

namespace bonemill {

Thesis2012Model::Thesis2012Model(const PenaltyContactConfig& contact, const CouplingConfig& coupling,
                                 const SpoWorld& world, const SpoTool& tool, double dt)
    : contact_(contact),
      coupling_(coupling),
      world_(world),
      tool_(tool.model),
      dt_(dt),
      X_VW_(world.volume.geometry().X_WV.inverse()) {}

void Thesis2012Model::setAccuracy(const AccuracySettings& settings) noexcept {
    contact_.shell_level = levelOf(world_.shell, settings);
}

ContactResult Thesis2012Model::contactInWorld(const Pose& spo_W) const noexcept {
    ContactResult contact =
        penaltyContact(contact_, world_.volume, world_.lattice, world_.shell, tool_->grid(), X_VW_ * spo_W);
    const Eigen::Quaterniond R_WV = X_VW_.rotation.conjugate();
    contact.wrench = contact.wrench.rotatedBy(R_WV);
    const Eigen::Matrix3d R = R_WV.toRotationMatrix();
    Matrix6d R6 = Matrix6d::Zero();
    R6.topLeftCorner<3, 3>() = R;
    R6.bottomRightCorner<3, 3>() = R;
    contact.derivative = R6 * contact.derivative * R6.transpose();
    return contact;
}

SpoStep Thesis2012Model::advance(const Pose& spo_W, const Pose& device_W) noexcept {
    const ContactResult contact = contactInWorld(spo_W);
    const Wrench net = contact.wrench + couplingWrench(coupling_, spo_W, device_W);
    const Matrix6d derivative = contact.derivative + couplingDerivative(coupling_, spo_W, device_W);
    const EquilibriumStep solved = solveEquilibrium(coupling_, net, derivative, dt_);
    const Vector6d moved = (1 - coupling_.static_damping) * solved.step;
    SpoStep step;
    step.spo = spo_W.incremented(moved.head<3>(), moved.tail<3>());
    step.wrench_hand = -couplingWrench(coupling_, step.spo, device_W);
    step.contacts = contact.contacts;
    step.iterations = 1;
    step.max_penetration = contact.max_penetration;
    step.is_solved = solved.is_found;
    step.is_motion_clamped = solved.is_clamped;
    return step;
}

}  // namespace bonemill
