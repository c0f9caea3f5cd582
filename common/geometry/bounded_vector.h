// Bounds the lengths of vectors; their directions stay, and no component becomes zero alone.
//
// It is RT-safe, for any thread. Values are finite and up to 1e307: squares that would overflow do no harm.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

// Scales `v` down to the length `longest`, and tells whether that was needed.
bool limitLength(Eigen::Vector3d& v, double longest) noexcept;

Eigen::Vector3d bounded(Eigen::Vector3d v, double longest) noexcept;

// What a device can give.
struct WrenchNorms {
    double max_force = 0;   // N
    double max_torque = 0;  // N·m
};

// Force and torque are bounded each by its own norm, so that a torque that a device cannot give takes nothing
// of the force.
Wrench bounded(const Wrench& wrench, const WrenchNorms& norms) noexcept;

}  // namespace bonemill
