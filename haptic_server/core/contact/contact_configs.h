// These say how stiff contact is, in both laws.
#pragma once

#include <cstdint>

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

}  // namespace bonemill
