// This is the thesis' penalty contact between the bone's point-shell and the tool's signed distance field
// (eq 4-16).
#pragma once

#include "common/geometry/pose.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/tool/sdf_grid.h"

namespace bonemill {

// A contact's wrench on the tool about the tool point (origin of T), and its derivative by the tool's world
// increment; axes V.
struct ContactWrench {
    Wrench wrench;
    Matrix6d derivative = Matrix6d::Zero();  // ∂(force, torque)/∂(x, ω)
    uint32_t contacts = 0;
    double max_depth = 0;  // m
};

// The derivative is as printed in eq 6-9, and kept wrong where the thesis is (docs/explanation/laws.md): eq
// 7 carries + k d n~ although the bone's normals do not turn with the tool, and eq 8 lacks + F~.
//
// Tests every shell point of the leaves that the tool's box meets. RT-safe; X_VT is the tool's pose in V.
ContactWrench penaltyContact(const PenaltyContactConfig& config, const VoxelVolume& volume,
                             const LeafLattice& lattice, const PointShell& shell, const SdfGrid& tool_sdf,
                             const Pose& X_VT) noexcept;

}  // namespace bonemill
