// These are kinematics and statics of a six-legged parallel device with vertical base-fixed linear actuators
// (ARES' layout, after Merlet): base, six sliders, links of constant length, platform with the handle.
//
// Frame D has its origin at the platform's centre in its neutral pose (level, every slider in the middle of
// its stroke), and +z along the actuators from the base to the platform. The neutral handle pose is therefore
// the identity, and the base plane lies below the origin. Frame T is fixed to the platform, with its
// origin at the centre. Leg i has the slider S_i = B_i + q_i z and the platform point P_i = p + R c_i with
// |P_i - S_i| = L; q = 0 is the stroke's low end. Twists are [v_DT; omega_D], wrenches [force; torque about
// T's origin], both in D. Units are m, rad, N, N·m.
//
// Everything here is RT-safe and thread-safe (const), and nothing throws. The formulas
// stand in docs/lab/device.md.
#pragma once

#include <array>

#include "common/geometry/pose.h"

namespace bonemill {

inline constexpr int kLegCount = 6;

// The dimensions are placeholders, since none of ARES is published: vertical axes, leg pairs about 0, 120
// and 240 degrees.
struct AresGeometry {
    double base_radius = 0.112;                   // m
    double platform_radius = 0.047;               // m
    double base_half_angle = 0.0593411945678072;  // rad (3.4 deg): half the angle of a pair on the base
    double platform_half_angle =
        0.949459113084915;       // rad (54.4 deg): half the angle of a pair on the platform
    double link_length = 0.210;  // m
    double stroke = 0.151;       // m
};

// Says why a pose is not usable (bit mask); 0 is usable.
enum WorkspaceFault : uint32_t {
    kWorkspaceOk = 0,
    kWorkspaceUnreachable = 1u << 0,  // a link is too short: no slider position exists
    kWorkspaceStroke = 1u << 1,       // a slider would leave its stroke
    kWorkspaceLean = 1u << 2,         // a link leans too far from its actuator (towards a serial singularity)
    kWorkspaceTurn = 1u << 3,         // the platform is turned too far for its joints
    kWorkspaceSingular = 1u << 4,     // the legs hardly hold the platform: see singularity.h
    kWorkspaceMirrored = 1u << 5,     // only another assembly of the same legs reaches this pose
};

// This is the smallest cosine between a link and its actuator's axis.
inline constexpr double kMinLinkCosine = 0.42;
// This is the largest turn (rad) from the neutral orientation, about any axis: 75 degrees. The nearest
// assembly with the same slider positions and the same handedness is turned by more than 135 degrees.
inline constexpr double kMaxTurn = 1.3089969389957472;

struct ForwardSolution {
    Pose X_DT;           // the last iterate, also when it did not converge
    int iterations = 0;  // Newton steps taken
    bool converged = false;
};

class AresKinematics {
  public:
    // A geometry whose neutral pose is impossible or singular gives an object with isBuildable() == false;
    // nothing else of it may be used then.
    explicit AresKinematics(const AresGeometry& geometry = {}) noexcept;

    bool isBuildable() const noexcept;
    const AresGeometry& geometry() const noexcept { return geometry_; }

    // Finds the slider positions for a handle pose; false when a link cannot reach (q is then unspecified).
    // It does not check the stroke: see workspaceFaults().
    bool inverse(const Pose& X_DT, Vector6d& q) const noexcept;

    // Finds J_inv with q_dot = J_inv [v; omega]; false when the pose is unreachable or serially singular.
    bool inverseJacobian(const Pose& X_DT, Matrix6d& J_inv) const noexcept;

    // Finds a handle pose for slider positions by Newton's method from `X_DT_start`, with at most
    // kMaxForwardIterations steps. If it does not converge, q is impossible or that too far away. If it does,
    // the pose may still be that of another assembly: locate() in pose_search.h tells.
    ForwardSolution forward(const Vector6d& q, const Pose& X_DT_start) const noexcept;

    // Finds how J_inv changes with each component of the twist [v; omega] at a pose: gradient[k] is dJ_inv
    // over a small motion along component k. False as inverseJacobian().
    bool inverseJacobianGradient(const Pose& X_DT, std::array<Matrix6d, 6>& gradient) const noexcept;

    // Returns those WorkspaceFault bits of a pose that are mechanical: reach, stroke, lean and turn. A pose
    // may lie beyond stroke and lean by `slack` (m); a negative slack asks for a distance from them.
    uint32_t workspaceFaults(const Pose& X_DT, double slack = 0) const noexcept;

    // Tells whether a pose with this Jacobian is assembled as the neutral pose is: no singularity need be
    // crossed between them.
    bool isOwnAssembly(const Matrix6d& J_inv) const noexcept;

    // Finds the height (m) of each link along its actuator, which is the link's length times the cosine of
    // its lean, and the gradient of each over the twist; false as inverseJacobian().
    bool linkHeights(const Pose& X_DT, Vector6d& heights, Matrix6d& gradient) const noexcept;

    static constexpr int kMaxForwardIterations = 12;
    static constexpr double kForwardTolerance = 1e-10;  // m, largest slider error

  private:
    struct Leg {
        Eigen::Vector3d base;      // B_i in D
        Eigen::Vector3d platform;  // c_i in T
    };
    // Finds the link vector P_i - S_i; false when it is unreachable.
    bool linkVector(const Leg& leg, const Pose& X_DT, Eigen::Vector3d& link, double& q) const noexcept;

    AresGeometry geometry_;
    double neutral_height_;  // of the platform over the base plane, m
    double handedness_ = 0;  // the sign of the neutral pose's det J_inv
    std::array<Leg, kLegCount> legs_;
};

// Returns the actuator forces (N, positive pushes along +q) that make the handle exert `wrench` on the hand:
// tau = J_inv^-T w. A singular J_inv gives non-finite forces, which must be limited
// (device_daemon/control/safety) before they go anywhere.
Vector6d actuatorForces(const Matrix6d& J_inv, const Wrench& wrench) noexcept;

// Returns the wrench on the hand that actuator forces make: w = J_inv^T tau.
Wrench wrenchOf(const Matrix6d& J_inv, const Vector6d& actuator_forces) noexcept;

}  // namespace bonemill
