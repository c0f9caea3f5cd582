// Soft walls stand before the ends of the workspace, so that the hand feels them before it hits a stop or the
// platform loses its stiffness: at both ends of every stroke, at the lean limit of every link, at the largest
// turn, and before singularities.
//
// Each wall is a zone of depth 0 at its face and 1 at its end. Its spring's force per unit of depth grows as
// a smoothstep and stays constant beyond, so that it is bounded and continuously differentiable; its energy
// is what the spring stores. A damper within the zone takes energy and never gives any; it too is bounded.
// Both do no more than the hand has done to them: the walls are passive but for the delay of the loop. It is
// RT-safe and pure. Frames and units: D about T's origin, m, N, N·m, J.
#pragma once

#include "common/ares_kinematics/ares_kinematics.h"

namespace bonemill {

struct SoftWallConfig {
    double stroke_width = 6e-3;  // m, before each end of the stroke
    double lean_width = 8e-3;    // m of link height, before the lean limit
    double turn_width = 0.14;    // rad, before the largest turn
    // These are smooth indices (smoothIndex()). Above the first there is no wall; the specified workspace
    // keeps above 0.59. The poses that are refused begin between the two.
    double singular_face = 0.50, singular_end = 0.36;
    // Six sliders in their walls at once are as stiff as 9 N/mm: three times the bone, and still calm at 1
    // kHz.
    double force = 6;      // N: of a spring at its end, on a slider or at a platform joint
    double torque = 0.2;   // N·m: of the turn's spring at its end
    double energy = 0.02;  // J: what a singularity's wall stores from its face to its end
    // A damper adds, or takes, up to this share of its spring, most of it where the depth changes faster than
    // 1 / damping_time.
    double damping_share = 0.6;
    double damping_time = 0.013;  // s
};

struct WallReaction {
    Wrench wrench_D;    // on the hand
    double energy = 0;  // J, stored in the springs
    bool touches = false;
};

class SoftWall {
  public:
    SoftWall(const AresKinematics& kinematics, const SoftWallConfig& config) noexcept
        : kinematics_(kinematics), config_(config) {}

    // Returns what the walls do at a pose with this Jacobian, to a handle with this twist [v; omega].
    WallReaction at(const Pose& X_DT, const Matrix6d& J_inv, const Vector6d& twist_D) const noexcept;

  private:
    struct Sum;
    void addStrokes(const Pose& X_DT, const Matrix6d& J_inv, Sum& sum) const noexcept;
    void addLeans(const Pose& X_DT, Sum& sum) const noexcept;
    void addTurn(const Pose& X_DT, Sum& sum) const noexcept;
    void addSingularity(const Pose& X_DT, const Matrix6d& J_inv, Sum& sum) const noexcept;

    AresKinematics kinematics_;
    SoftWallConfig config_;
};

}  // namespace bonemill
