// penalty_sdf: every contact point pushes in proportion to its depth in the other body's distance field,
// along its own normal; the tool stands where that and the coupling are in balance, found by one linear step
// a tick with the exact derivative of the contact wrench.
//
// After Barbič and James, "Six-DoF haptic rendering of contact between geometrically complex reduced
// deformable models", IEEE Transactions on Haptics 1(1), 2008, without deformation. The roles are exchanged:
// here the points are the bone's, whose shell follows the milling, and the field is the tool's, which never
// changes; a field of the bone would have to be made anew with every voxel. docs/research/laws.md has the
// equations.
#pragma once

#include "haptic_server/laws/compared_law.h"
#include "haptic_server/laws/near_points.h"
#include "haptic_server/laws/quasi_static_step.h"

namespace bonemill {

class PenaltySdf final : public ComparedLaw {
  public:
    static constexpr size_t kMaxPoints = 16384;  // in the tool

    PenaltySdf(const LawConfig& config, const SpoWorld& world, const SpoTool& tool, double dt)
        : ComparedLaw(config, world, tool, dt), points_(kMaxPoints) {}

    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override;
    // The contacts at this pose, by the live bone; `has_room` is false if there were more than kMaxPoints.
    ContactWrench contactAt(const Pose& X_VT, bool& has_room) noexcept;

  private:
    NearPoints points_;
};

}  // namespace bonemill
