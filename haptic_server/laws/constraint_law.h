// constraint: the rigid tool goes towards the hand in all six degrees of freedom as far as its contacts let
// it, by Gauss' principle of least constraint, and never into the bone; the hand feels the coupling's spring.
// It is the limit of the gradient law for a contact of infinite stiffness. There is no friction.
//
// After Ortega, Redon and Coquillart, "A six degree-of-freedom god-object method for haptic display of rigid
// bodies with surface properties", IEEE TVCG 13(3), 2007, and for live volumes Chan, Conti, Blevins and
// Salisbury, "Constraint-based six degree-of-freedom haptic rendering of volume-embedded isosurfaces", World
// Haptics 2011. The metric is the coupling's stiffness in place of a mass; the contacts are the bone's points
// against the tool's exact distance. docs/explanation/laws.md has the equations.
#pragma once

#include "haptic_server/laws/blocked_motion.h"
#include "haptic_server/laws/compared_law.h"

namespace bonemill {

class ConstraintLaw final : public ComparedLaw {
  public:
    using ComparedLaw::ComparedLaw;

    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override {
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
    void restart() noexcept override {
        ComparedLaw::restart();
        motion_.restart();
    }
    // What the contacts held the tool back with in the last advance(), for tests: as a wrench of the coupling
    // without saturation, torque about the tool point.
    const Wrench& reaction() const noexcept { return reaction_; }

  private:
    // The coupling's stiffness about the tool point, unsaturated: its force acts at the grip.
    static Matrix6d stiffnessOf(const EnergyCoupling& coupling, const Pose& X_VT) noexcept {
        Eigen::Matrix<double, 3, 6> at_grip;
        at_grip << Eigen::Matrix3d::Identity(), -skew(X_VT.rotation * coupling.p_TG);
        Matrix6d K = coupling.translation_stiffness * at_grip.transpose() * at_grip;
        K.bottomRightCorner<3, 3>().diagonal().array() += coupling.rotation_stiffness;
        return K;
    }

    BlockedMotion motion_;
    Wrench reaction_;
};

}  // namespace bonemill
