// Bone whose materials are ranges of the scan's values is drawn in shades between their colours: what a
// scanner sees is continuous, and no finer than its voxels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/geometry/pose.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Which numbers vertices get in NodeMesh::materials, for which densities.
struct ShadeScale {
    uint8_t first = 0;                   // of the lowest shade
    int count = 0;                       // 0: there are no shades
    Density low = 0, high = 0;           // of the first and of the last shade, low < high
    std::array<bool, 256> stands_for{};  // materials that are drawn so, by MaterialId

    uint8_t at(float density) const noexcept;
};

// The scan as it was, smoothed over its own voxels. It belongs to one thread; not RT-safe: it remembers what
// it has computed, one byte per voxel of the bricks that hold surface.
class ScanShade {
  public:
    using DensityAt = std::function<Density(const Eigen::Vector3i& voxel)>;  // 0 outside

    // `scan` has the voxels of `density_at`; X_SV places a mesh (V) in their frame. What is below iso is no
    // bone.
    ScanShade(const ShadeScale& scale, const VolumeGeometry& scan, const Pose& X_SV, Density iso,
              DensityAt density_at);

    // The shade of a place of a surface (V, m) with this normal (V, outwards, of any length).
    uint8_t under(const Eigen::Vector3f& p_V, const Eigen::Vector3f& normal_V);
    const ShadeScale& scale() const noexcept { return scale_; }

  private:
    static constexpr int kBrick = 16;  // voxels along an edge
    using Brick = std::array<uint8_t, size_t(kBrick) * kBrick * kBrick>;

    uint8_t& knownAt(const Eigen::Vector3i& voxel);
    float smoothAt(const Eigen::Vector3i& voxel);
    float computedAt(const Eigen::Vector3i& voxel) const;

    ShadeScale scale_;
    Eigen::Vector3i dims_;
    Eigen::Vector3f spacing_;
    Eigen::Matrix3f R_SV_;
    Eigen::Vector3f p_SV_;
    Density iso_;
    DensityAt density_at_;
    Eigen::Vector3i bricks_;                     // per axis
    std::vector<std::unique_ptr<Brick>> known_;  // 0: not yet computed
};

// As the volume is; it must outlive what is returned, and is not written.
ScanShade::DensityAt densitiesOf(const VoxelVolume& volume);

}  // namespace bonemill
