// vps: the tool is a shell of points, the bone a map of voxels that are bone or not. A point that has got
// into bone is pushed along its own normal by a spring, from the plane at right angles to it through the
// middle of the bone's surface voxel (the tangent plane).
//
// After McNeely, Puterbaugh and Troy, "Six degree-of-freedom haptic rendering using voxel sampling", SIGGRAPH
// 1999, and "Voxel-based 6-DOF haptic rendering improvements", Haptics-e 3(7), 2006, with the quasi-static
// coupling of Wan and McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", IEEE
// Visualization 2003. Their map is precomputed; this one is the live density against the iso-value, so that
// milled bone is felt at once. It knows no distance: below the surface voxel the point looks for it along its
// normal, kLayers voxels far, in place of their distance field of some layers. docs/research/laws.md has the
// equations.
#pragma once

#include "haptic_server/laws/compared_law.h"
#include "haptic_server/laws/quasi_static_step.h"
#include "haptic_server/laws/tool_points.h"

namespace bonemill {

class Vps final : public ComparedLaw {
  public:
    static constexpr int kLayers = 3;  // voxels below the surface voxel in which a point still finds it

    // `tools` are all that setTool() may be called with. It allocates.
    Vps(const LawConfig& config, const SpoWorld& world, std::span<const SpoTool> tools, const SpoTool& tool,
        double dt);

    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override;
    void setTool(const SpoTool& tool) noexcept override;
    // The contacts at this pose, by the live voxels.
    ContactWrench contactAt(const Pose& X_VT) noexcept;

    const ToolPoints& points() const noexcept { return *points_; }

  private:
    struct Sums;
    void test(const ToolPoints::Cluster& cluster, const Pose& X_VT, Sums& sums) noexcept;
    bool mayHoldBone(const Eigen::Vector3d& center, double radius) const noexcept;
    bool isBone(const Eigen::Vector3i& voxel) const noexcept;
    double depthBelowSurface(const Eigen::Vector3d& p, const Eigen::Vector3d& inward) const noexcept;

    struct OfTool {
        const ToolModel* model;
        ToolPoints points;
    };
    std::vector<OfTool> of_tools_;
    const ToolPoints* points_ = nullptr;
    Eigen::Vector3d inverse_spacing_;
    uint32_t tested_ = 0;  // points, in this tick
};

}  // namespace bonemill
