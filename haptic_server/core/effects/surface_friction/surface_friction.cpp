#include "haptic_server/core/effects/surface_friction/surface_friction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/increment.h"

namespace bonemill {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// A spring about to slip counts as slipping in the stiffness: a tool that slides, at the width again after
// each tick, would otherwise begin every solve with too short a step.
constexpr double kAboutToSlip = 0.99;
// These are shares of the stiffest motion's stiffness, rotations measured at the farthest contact: what is
// softer than the first is free, what is softer than the second partly.
constexpr double kFree = 3e-4, kHeld = 3e-3;

double smoothstep(double t) noexcept {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

using Jacobian = Eigen::Matrix<double, 3, 6>;  // of a place's motion by the tool's

Jacobian jacobianOf(const Vector3d& r) noexcept {
    Jacobian J;
    J << Matrix3d::Identity(), -skew(r);
    return J;
}

}  // namespace

void SurfaceFriction::forget() noexcept {
    groups_.clear();
    stretch_.setZero();
    stored_ = given_ = 0;
}

EnergyTerm SurfaceFriction::at(const Vector6d& stretch) const noexcept {
    EnergyTerm term;
    const double width = slipWidth();
    if (!(width > 0)) return term;
    for (const ContactGroup& group : groups_.groups()) {
        const Vector3d moved = stretch.head<3>() + stretch.tail<3>().cross(group.r);
        const Vector3d slid = group.tangential * moved;
        const double s = std::sqrt(std::max(0.0, moved.dot(slid))), most = config_.coefficient * group.force;
        const bool sticks = s <= width;
        const double secant = most / (sticks ? width : s);
        const Vector3d force = -secant * slid;
        term.energy += most * (sticks ? s * s / (2 * width) : s - width / 2);
        term.wrench.force += force;
        term.wrench.torque += group.r.cross(force);
        Matrix3d K = secant * group.tangential;
        if (s > kAboutToSlip * width) K -= secant / (s * s) * slid * slid.transpose();
        const Jacobian J = jacobianOf(group.r);
        term.stiffness += J.transpose() * K * J;
    }
    return term;
}

EnergyTerm SurfaceFriction::energy(const EffectTick& tick, const Pose& X_VT) const noexcept {
    const Increment step(tick.X_VT_start, X_VT);
    EnergyTerm term = at(stretch_ + step.twist);
    term.wrench = step.wrenchOf(term.wrench);
    return term;
}

// The contacts are those that the last tick ended with.
void SurfaceFriction::begin(EffectTick& tick) noexcept {
    groups_.gather(tick, 1 - spinShare(tick.spin_speed, tick.tool->burr));
    if (!(slipWidth() > 0)) return forget();
    const double now = at(stretch_).energy, gain = now - stored_;
    if (gain > given_) {
        stretch_ *= (stored_ + given_) / now;  // convex: so much less at least
        given_ = 0;
    } else {
        given_ = std::min(given_ - gain, now);
    }
}

double SurfaceFriction::meanStretch(const Vector6d& stretch) const noexcept {
    double sum = 0;
    for (const ContactGroup& group : groups_.groups()) {
        const Vector3d moved = stretch.head<3>() + stretch.tail<3>().cross(group.r);
        sum += group.force * moved.dot(group.tangential * moved);
    }
    return std::sqrt(sum / groups_.force());
}

void SurfaceFriction::giveWay() noexcept {
    const double mean = meanStretch(stretch_), width = slipWidth();
    if (mean > width) stretch_ *= width / mean;
}

void SurfaceFriction::forgetFreeMotion() noexcept {
    double lever = 0;
    for (const ContactGroup& group : groups_.groups()) lever = std::max(lever, group.r.norm());
    if (lever == 0) return;
    Vector6d unit;  // a turn as the way of the farthest contact
    unit << 1, 1, 1, 1 / lever, 1 / lever, 1 / lever;
    Matrix6d held = Matrix6d::Zero();
    for (const ContactGroup& group : groups_.groups()) {
        const Jacobian J = jacobianOf(group.r) * unit.asDiagonal();
        held += group.force * J.transpose() * group.tangential * J;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6d> modes(held);
    const Vector6d& stiffness = modes.eigenvalues();  // ascending
    if (modes.info() != Eigen::Success || stiffness[0] >= kHeld * stiffness[5]) return;
    Vector6d amplitude = modes.eigenvectors().transpose() * stretch_.cwiseQuotient(unit);
    for (int n = 0; n < 6; ++n)
        amplitude[n] *= smoothstep((stiffness[n] / stiffness[5] - kFree) / (kHeld - kFree));
    stretch_ = unit.cwiseProduct(modes.eigenvectors() * amplitude);
}

void SurfaceFriction::finish(EffectTick& tick) noexcept {
    if (!(slipWidth() > 0)) return;
    stretch_ += Increment(tick.X_VT_start, tick.X_VT).twist;
    forgetFreeMotion();
    giveWay();
    stored_ = at(stretch_).energy;
}

std::unique_ptr<HapticEffect> SurfaceFrictionConfig::make(const EffectNeeds&) const {
    return std::make_unique<SurfaceFriction>(*this);
}

}  // namespace bonemill
