// The tool's surface as points with normals, for laws that look for them in the bone's voxels (McNeely's
// point shell). They are the surface's crossings of a regular grid, one for each cell that it crosses. They
// are made at the start; looking at them is RT-safe, for any thread.
//
// The frame is T, the unit m.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

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

}  // namespace bonemill
