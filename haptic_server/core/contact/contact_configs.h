// These say how stiff contact is, in both laws, and what else the gradient law is told.
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/base/units.h"
#include "haptic_server/core/coupling/energy_coupling.h"

namespace bonemill {

// It is for the gradient law.
struct GradientContactConfig {
    double stiffness_per_area = 1e12;  // κ, N/m³
    double stiffness_cap = 1e7;        // N/m in any direction; infinity: none
};

// It is for the thesis' law.
struct PenaltyContactConfig {
    double point_stiffness = 1200;          // N/m per contact point (thesis k_c = 1.2 N/mm)
    uint32_t full_stiffness_contacts = 10;  // eq 10: above it each stiffness becomes k·limit/N
    int shell_level = 0;                    // of the PointShell: whose points are tested
};

// The gradient law is told this at the start.
struct GradientConfig {
    GradientContactConfig contact;
    EnergyCouplingConfig coupling;
    double max_speed = 0.5;                    // m/s of the tool point
    double max_angular_speed = 240 * kDegree;  // rad/s
    // About this many points may be tested in a tick; a test is one point's distance, energy and wrench at
    // one pose. A quarter as many candidates have room.
    size_t most_point_tests = 2'000'000;
};

}  // namespace bonemill
