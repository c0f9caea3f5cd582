// The milled bone of a scene with a volume.region goes on beyond the region's faces, for people to look at.
#pragma once

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// The milled bone (V) at its faces as it was at the start: its outermost voxels, and the two layers beyond
// them, which the tick knows nothing of. It never changes: any thread may read it; RT-safe.
class RegionRim {
  public:
    static constexpr int kLayers = 2;  // a surface up to the first one has gradients that need the second

    // `beyond` is asked for the density of voxels outside the region. Allocates; start-up only.
    template <class Beyond>
    RegionRim(const VoxelVolume& region, Beyond&& beyond)
        : region_(IndexBox{Eigen::Vector3i::Zero(), region.dims().array() - 1}),
          rim_(around(region), region.iso()) {
        const IndexBox rows{{0, readable().min.y(), readable().min.z()},
                            {0, readable().max.y(), readable().max.z()}};
        const IndexBox deep = region_.grown(-1);
        forEachIndex(rows, [&](const Eigen::Vector3i& row) {
            for (Eigen::Vector3i v(readable().min.x(), row.y(), row.z()); v.x() <= readable().max.x();
                 ++v.x()) {
                if (deep.contains(v)) v.x() = deep.max.x() + 1;
                const Density density = region_.contains(v) ? region.at(v.x(), v.y(), v.z()) : beyond(v);
                if (density > 0) rim_.set(v.x() + kLayers, v.y() + kLayers, v.z() + kLayers, density);
            }
        });
    }

    const IndexBox& region() const noexcept { return region_; }  // voxels of V
    const Eigen::Vector3d& spacing() const noexcept { return rim_.spacing(); }
    // Voxels of V that may be read. Deep within the region they are air.
    IndexBox readable() const noexcept { return region_.grown(kLayers); }
    Density at(const Eigen::Vector3i& v) const noexcept {
        return rim_.at(v.x() + kLayers, v.y() + kLayers, v.z() + kLayers);
    }

  private:
    static VolumeGeometry around(const VoxelVolume& region) {
        VolumeGeometry geometry = region.geometry();
        geometry.dims.array() += 2 * kLayers;
        geometry.X_WV.position = geometry.X_WV * Eigen::Vector3d(-kLayers * geometry.spacing);
        return geometry;
    }

    IndexBox region_;
    VoxelVolume rim_;
};

}  // namespace bonemill
