#include "haptic_server/core/equilibrium/thesis_2012_model.h"

namespace bonemill {

Thesis2012Model::Thesis2012Model(const PenaltyContactConfig& contact, const CouplingConfig& coupling,
                                 const SpoWorld& world, const SpoTool& tool, double dt)
    : contact_(contact), coupling_(coupling), world_(world), tool_(tool.model), dt_(dt) {}

void Thesis2012Model::setAccuracy(const AccuracySettings& settings) noexcept {
    contact_.shell_level = levelOf(world_.shell, settings);
}

SpoStep Thesis2012Model::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    const ContactResult contact =
        penaltyContact(contact_, world_.volume, world_.lattice, world_.shell, tool_->grid(), X_VT);
    const Wrench net = contact.wrench + couplingWrench(coupling_, X_VT, X_VT_device);
    const Matrix6d derivative = contact.derivative + couplingDerivative(coupling_, X_VT, X_VT_device);
    const EquilibriumStep solved = solveEquilibrium(coupling_, net, derivative, dt_);
    const Vector6d moved = (1 - coupling_.static_damping) * solved.step;
    SpoStep step;
    step.X_VT = X_VT.incremented(moved.head<3>(), moved.tail<3>());
    step.wrench_hand_V = -couplingWrench(coupling_, step.X_VT, X_VT_device);
    step.contacts = contact.contacts;
    step.iterations = 1;
    step.max_penetration = contact.max_penetration;
    step.is_solved = solved.is_found;
    step.is_motion_clamped = solved.is_clamped;
    return step;
}

}  // namespace bonemill
