// These are the thesis' static virtual coupling, equilibrium step and feedback (§4.3.3-4.3.5). All
// functions are RT-safe.
#pragma once

#include "common/base/units.h"
#include "common/geometry/pose.h"

namespace bonemill {

struct CouplingConfig {
    double translation_stiffness = 3000;  // N/m (k_vct)
    double rotation_stiffness =
        1.0;                 // N·m per unit quaternion vector part (k_vcr); k_vcr/2 per rad at small angles
    double max_speed = 0.5;  // m/s, of the step before damping: the tool moves at (1 - α) of it at most
    double max_angular_speed =
        240 * kDegree;            // rad/s, before damping; the thesis' "0.073 rad per ms" is a slip (0.00419)
    double static_damping = 0.5;  // α: the tool moves by (1 - α) of the step
};

// Returns the coupling wrench on the tool about the tool point (eq 17-18, 32-33): springs from the SPO to the
// device pose. The quaternion's sign is chosen for the shorter way round.
Wrench couplingWrench(const CouplingConfig& config, const Pose& X_VT, const Pose& X_VT_device) noexcept;

// Returns ∂(force, torque)/∂(x, ω) of couplingWrench (eq 19-22).
Matrix6d couplingDerivative(const CouplingConfig& config, const Pose& X_VT, const Pose& X_VT_device) noexcept;

struct EquilibriumStep {
    Vector6d step = Vector6d::Zero();  // (Δx, Δω) before damping; zero if nothing finite could be found
    bool is_regular = false;           // false: the matrix was singular or something was not finite
    bool is_found = false;             // false: nothing finite was found, also not with a regularised matrix
    bool is_clamped = false;           // a speed limit acted
};

// Solves W + derivative · step = 0 (eq 25) by LU and limits the step to the speeds allowed in dt, in
// direction. A singular matrix (the quaternion coupling at exactly 180°) is regularised, so that the tool
// moves on.
EquilibriumStep solveEquilibrium(const CouplingConfig& config, const Wrench& wrench,
                                 const Matrix6d& derivative, double dt) noexcept;

}  // namespace bonemill
