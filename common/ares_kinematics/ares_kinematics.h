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
// stand in docs/reference/ares.md.
#pragma once

#include <array>

#include "common/geometry/pose.h"

namespace bonemill {

// There are two measures of how well the legs hold the platform: 1 alike in every direction, 0 not at all in
// one. Both are of A = J_inv diag(I, I / kConditioningLength), which makes a turn and a shift comparable.
inline constexpr double kConditioningLength = 0.030;  // m

// A pose below this index is refused: rounding, encoder steps and forces grow too much there, and a little
// further on another assembly of the same legs begins. The specified workspace keeps above 0.22.
inline constexpr double kMinSingularityIndex = 0.1;
// A pose below this is so near the singularity that the platform may have gone through it.
inline constexpr double kLostSingularityIndex = 0.02;

// Returns sigma_min / sigma_max of A, exact above 1e-7; 0 is singular.
double singularityIndex(const Matrix6d& J_inv) noexcept;

// Returns 6 / (|A| |A^-1|) in the Frobenius norm: the same at 0 and 1, between the index and six times the
// index elsewhere, and smooth, which the index is not where singular values meet. 0 if J_inv is singular.
double smoothIndex(const Matrix6d& J_inv) noexcept;

// Returns the change of smoothIndex() when J_inv changes by J_inv_change, per unit of it.
double smoothIndexChange(const Matrix6d& J_inv, const Matrix6d& J_inv_change) noexcept;

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
    kWorkspaceSingular = 1u << 4,     // the legs hardly hold the platform: kMinSingularityIndex
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
    // the pose may still be that of another assembly: locate() tells.
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

// Six slider positions fit several poses: a six-legged platform has up to 40 assemblies. Only one of them
// lies in the workspace that may be believed: turned by no more than kMaxTurn, assembled as the neutral pose,
// better conditioned than kMinSingularityIndex, and within stroke and lean. That there is no second one is
// measured, not proved: tests/property/common/ares_kinematics.
//
// Encoders, and a stop that gives way, may show so much beyond stroke and lean (m).
inline constexpr double kWorkspaceSlack = 1e-3;

struct Location {
    bool is_found = false;  // X_DT has these slider positions, whether or not it may be believed
    uint32_t faults = kWorkspaceUnreachable;  // WorkspaceFault bits; without any it may be believed
    Pose X_DT;
    Matrix6d J_inv = Matrix6d::Zero();  // there
    double singularity_index = 0;       // there

    bool isBelieved() const noexcept { return is_found && faults == kWorkspaceOk; }
};

// Finds the handle pose that six slider positions mean, or says that it does not know, from X_DT_start: the
// pose of a moment ago, or the neutral one. Whoever follows a moving handle must always start from its last
// pose, also where that was not believed: a search from elsewhere could find a pose that looks well while the
// handle is in an assembly that does not.
Location locate(const AresKinematics& kinematics, const Vector6d& q, const Pose& X_DT_start) noexcept;

inline constexpr double kSpecifiedTurn = 0.6981317007977318;  // rad: 40 degrees, what ARES was asked for

// Returns the radius of the largest ball around D's origin in which the handle may be turned by `turn` about
// any axis without leaving the workspace or coming near a singularity: for people, and for the server that
// adapts to it. It is sampled in fixed directions, and takes milliseconds: for start-up.
double reachRadius(const AresKinematics& kinematics, double turn) noexcept;

}  // namespace bonemill
