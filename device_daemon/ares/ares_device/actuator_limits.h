// The last stop before the motors: what holds the arm and keeps it inside goes first, and the wrench that the
// hand is to feel gets what is left of every motor.
//
// It is pure and RT-safe. Forces are on the sliders, N.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

struct LimitedForces {
    Vector6d forces = Vector6d::Zero();
    double wanted_share =
        0;  // of `wanted` in them, 0 to 1: one factor for all six, so that it keeps its direction
    double base_share = 0;  // of `base`, likewise; below 1 only where the base alone is too much
    bool is_finite = true;  // if not, all forces are zero
};

// Returns base + share * wanted with no force beyond `largest`, which must be positive.
LimitedForces limitForces(const Vector6d& base, const Vector6d& wanted, double largest) noexcept;

}  // namespace bonemill
