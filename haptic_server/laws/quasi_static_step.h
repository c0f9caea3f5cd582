// One linear step towards the pose at which the contacts' wrench and the coupling's are in balance, damped
// and within the speed limits: what vps and penalty_sdf share with the thesis' law (Wan and McNeely 2003;
// Barbič and James 2008). It is RT-safe.
#pragma once

#include "haptic_server/core/coupling/energy_coupling.h"
#include "haptic_server/core/coupling/virtual_coupling.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

// A contact's wrench on the tool about the tool point, and its derivative by the tool's world increment.
struct ContactWrench {
    Wrench wrench;
    Matrix6d derivative = Matrix6d::Zero();
    uint32_t contacts = 0;
    double max_depth = 0;  // m
};

// Returns the pose after the step, and fills all of `out` but what the hand feels.
inline Pose quasiStaticStep(const ContactWrench& contact, const EnergyTerm& coupling,
                            const CouplingConfig& limits, const Pose& X_VT, double dt,
                            SpoStep& out) noexcept {
    const Matrix6d derivative = contact.derivative - coupling.stiffness;
    const EquilibriumStep solved = solveEquilibrium(limits, contact.wrench + coupling.wrench, derivative, dt);
    out.contacts = contact.contacts;
    out.iterations = 1;
    out.max_penetration = contact.max_depth;
    out.is_solved = solved.is_found;
    out.is_motion_clamped = solved.is_clamped;
    const Vector6d moved = (1 - limits.static_damping) * solved.step;
    return X_VT.incremented(moved.head<3>(), moved.tail<3>());
}

}  // namespace bonemill
