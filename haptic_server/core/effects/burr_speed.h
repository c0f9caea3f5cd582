// This says how burr and bone rub on each other where they touch, in SI and axes V. It is
// RT-safe and thread-safe.
#pragma once

#include <algorithm>
#include <cmath>

#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

// A contact's patch adds this to the square of its distance from the axis, m²: a disc of this area that turns
// about its own middle rubs at 2/3 of its radius on average.
inline double patchSpread(double area) noexcept {
    constexpr double kMeanRadiusSquared = 4.0 / 9;  // of a disc, per its radius squared
    return kMeanRadiusSquared / M_PI * area;
}

// It is ρ, m: at this times the spin speed a place of `area` (m²) at r from the tool point rubs, as the mean
// over its patch.
inline double rubbingRadius(const Eigen::Vector3d& r, const Eigen::Vector3d& axis, double area) noexcept {
    return std::sqrt(axis.cross(r).squaredNorm() + patchSpread(area));
}

// Tangential per normal force of the burr as a whole.
inline double frictionOf(const EffectTick& tick) noexcept {
    const Burr& burr = tick.tool->burr;
    return burr.rubbing_friction + tick.cut_share * (burr.friction - burr.rubbing_friction);
}

// How much of the burr's friction is that of a turning burr, 0 .. 1; the rest is that of one that stands.
inline double spinShare(double spin_speed, const Burr& burr) noexcept {
    constexpr double kSlowRim = 10e-3;  // m/s: what is slower rather sticks
    return std::min(1.0, std::abs(spin_speed) * burr.radius / kSlowRim);
}

// Calls visit(contact, r, ρ) for each contact on the burr.
template <class Visit>
void forEachBurrContact(const EffectTick& tick, Visit&& visit) noexcept {
    for (size_t n = 0; n < tick.contacts.size(); ++n)
        if (tick.is_on_burr[n])
            visit(tick.contacts[n], Eigen::Vector3d(tick.contacts[n].r_V.cast<double>()),
                  tick.rubbing_radius[n]);
}

inline BurrLoad burrLoadOf(const EffectTick& tick) noexcept {
    BurrLoad load;
    forEachBurrContact(tick, [&](const SurfaceContact& contact, const Eigen::Vector3d&, double rho) {
        load.force += double(contact.force);
        load.moment += double(contact.force) * rho;
        ++load.contacts;
    });
    return load;
}

}  // namespace bonemill
