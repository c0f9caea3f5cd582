// Kinematics and statics of a six-legged parallel device with vertical base-fixed linear actuators (ARES'
// layout, after Merlet): base, six sliders, constant-length links, platform with the handle.
//
// Frame D: origin at the platform centre in its neutral pose (level, every slider in the middle of its
// stroke), +z along the actuators from the base to the platform. The neutral handle pose is therefore the
// identity and the base plane lies at z = -neutralHeight(). Frame T: fixed to the platform, origin at its
// centre. Per leg i: slider S_i = B_i + q_i z, platform point P_i = p + R c_i, |P_i - S_i| = L; q = 0 is the
// stroke's low end. Twists are [v_DT; omega_D], wrenches [force; torque about T's origin], both in D. Units
// m, rad, N, N·m.
//
// Everything here is RT-safe, thread-safe (const) and never throws. Formulas: docs/device.md.
#pragma once

#include <array>

#include "common/geometry/pose.h"

namespace bonemill {

inline constexpr int kLegCount = 6;

// Placeholder dimensions (no dimension of ARES is published): vertical axes, leg pairs about 0/120/240
// degrees.
struct AresGeometry {
    double base_radius = 0.112;                   // m
    double platform_radius = 0.047;               // m
    double base_half_angle = 0.0593411945678072;  // rad (3.4 deg): half the angle of a pair on the base
    double platform_half_angle =
        0.949459113084915;       // rad (54.4 deg): half the angle of a pair on the platform
    double link_length = 0.210;  // m
    double stroke = 0.151;       // m
};

// Why a pose is not usable (bit mask); 0 is usable.
enum WorkspaceFault : uint32_t {
    kWorkspaceOk = 0,
    kWorkspaceUnreachable = 1u << 0,  // a link is too short: no slider position exists
    kWorkspaceStroke = 1u << 1,       // a slider would leave its stroke
    kWorkspaceLean = 1u << 2,         // a link leans too far from its actuator (towards a serial singularity)
};

// Smallest cosine between a link and its actuator axis.
inline constexpr double kMinLinkCosine = 0.42;

// Length that makes rotation and translation comparable in the singularity index.
inline constexpr double kConditioningLength = 0.030;

struct ForwardSolution {
    Pose X_DT;           // the last iterate, also when it did not converge
    int iterations = 0;  // Newton steps taken
    bool converged = false;
};

class AresKinematics {
  public:
    // A geometry whose neutral pose is impossible gives an object with isBuildable() == false; nothing else
    // of it may be used then.
    explicit AresKinematics(const AresGeometry& geometry = {}) noexcept;

    bool isBuildable() const noexcept;
    const AresGeometry& geometry() const noexcept { return geometry_; }
    double neutralHeight() const noexcept {
        return neutral_height_;
    }  // of the platform over the base plane, m

    // Slider positions for a handle pose; false when a link cannot reach (q is then unspecified). Limits of
    // the stroke are not checked: see workspaceFaults().
    bool inverse(const Pose& X_DT, Vector6d& q) const noexcept;

    // J_inv with q_dot = J_inv [v; omega]; false when the pose is unreachable or serially singular.
    bool inverseJacobian(const Pose& X_DT, Matrix6d& J_inv) const noexcept;

    // Handle pose for slider positions: Newton from `start`, at most kMaxForwardIterations steps. Not
    // converged means that q is impossible or `start` too far away.
    ForwardSolution forward(const Vector6d& q, const Pose& start) const noexcept;

    // WorkspaceFault bits of a pose.
    uint32_t workspaceFaults(const Pose& X_DT) const noexcept;

    static constexpr int kMaxForwardIterations = 12;
    static constexpr double kForwardTolerance = 1e-10;  // m, largest slider error

  private:
    struct Leg {
        Eigen::Vector3d base;      // B_i in D
        Eigen::Vector3d platform;  // c_i in T
    };
    // Link vector P_i - S_i; false when unreachable.
    bool linkVector(const Leg& leg, const Pose& X_DT, Eigen::Vector3d& link, double& q) const noexcept;

    AresGeometry geometry_;
    double neutral_height_;
    std::array<Leg, kLegCount> legs_;
};

// Actuator forces (N, positive pushes along +q) that make the handle exert `wrench` on the hand: tau =
// J_inv^-T w. A singular J_inv gives non-finite forces: limit them (device_daemon/safety) before they go
// anywhere.
Vector6d actuatorForces(const Matrix6d& J_inv, const Wrench& wrench) noexcept;

// The wrench on the hand that actuator forces make: w = J_inv^T tau.
Wrench wrenchOf(const Matrix6d& J_inv, const Vector6d& actuator_forces) noexcept;

// sigma_min / sigma_max of J_inv diag(I, I / kConditioningLength); 0 is singular.
double singularityIndex(const Matrix6d& J_inv) noexcept;

}  // namespace bonemill
