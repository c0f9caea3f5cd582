// vps: the tool is a shell of points, the bone a map of voxels that are bone or not. A point that has got
// into bone is pushed along its own normal by a spring, from the plane at right angles to it through the
// middle of the bone's surface voxel (the tangent plane).
//
// After McNeely, Puterbaugh and Troy, "Six degree-of-freedom haptic rendering using voxel sampling", SIGGRAPH
// 1999, and "Voxel-based 6-DOF haptic rendering improvements", Haptics-e 3(7), 2006, with the quasi-static
// coupling of Wan and McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", IEEE
// Visualization 2003. Their map is precomputed; this one is the live density against the iso-value, so that
// milled bone is felt at once. It knows no distance: below the surface voxel the point looks for it along its
// normal, kLayers voxels far, in place of their distance field of some layers. docs/explanation/laws.md has
// the equations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/core/tool/tool_field.h"
#include "haptic_server/laws/compared_law.h"

namespace bonemill {

// The tool's surface as points with normals, for laws that look for them in the bone's voxels (McNeely's
// point shell). They are the surface's crossings of a regular grid, one for each cell that it crosses. They
// are made at the start; looking at them is RT-safe, for any thread.
//
// The frame is T, the unit m.
struct ToolPoint {
    Eigen::Vector3f position;
    Eigen::Vector3f inward;  // unit, into the tool
};

class ToolPoints {
  public:
    static constexpr size_t kMax = 16384;

    // Cells of `spacing`; wider ones if there would be more than kMax points. It allocates.
    ToolPoints(const ToolField& tool, double spacing);

    // Points that lie beside each other, with a ball around them.
    struct Cluster {
        Eigen::Vector3d center;
        double radius;
        uint32_t first, count;
    };
    std::span<const Cluster> clusters() const noexcept { return clusters_; }
    std::span<const ToolPoint> pointsOf(const Cluster& cluster) const noexcept {
        return {points_.data() + cluster.first, cluster.count};
    }
    size_t count() const noexcept { return points_.size(); }
    double spacing() const noexcept { return spacing_; }

  private:
    void sample(const ToolField& tool);
    void addCluster(const ToolField& tool, const Eigen::Vector3d& first_center);

    double spacing_;
    std::vector<ToolPoint> points_;
    std::vector<Cluster> clusters_;
};

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
