// Knows at which tick of a recording each voxel was removed: it looks at what the ticks have changed, one
// after the other. Voxels count as removed below the iso-value, as in TickRecord::removed_voxels.
//
// One thread adds; any may ask meanwhile. It takes a mutex, and memory for the leaves that were milled.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

class RemovalMap {
  public:
    // The bone as it is before the first tick, and the one that ticks change; both must outlive the map.
    RemovalMap(const VoxelVolume& start, const VoxelVolume& bone);

    // The tick of this number has changed voxels in this box only (ends included). One that was put back, or
    // added, may be removed once more.
    void add(uint64_t tick, const IndexBox& changed);
    // The bone was put back to what it was at some moment: what is bone now is looked up.
    void lookAnew();

    struct Removal {
        uint64_t tick;
        Eigen::Vector3i voxel;
    };
    // Returns the removal nearest to the place (V, m) within `radius` (m): of voxels that were removed at
    // tick `now` if there is any, as of the bone that is seen then, else of all.
    std::optional<Removal> nearest(const Eigen::Vector3d& place_V, double radius, uint64_t now) const;

  private:
    static constexpr int kBlock = 16;  // voxels per axis
    static constexpr size_t kVoxels = size_t(kBlock) * kBlock * kBlock;
    // Of each voxel 1 + the tick that removed it first (0: none), and whether it is bone now.
    struct Block {
        std::vector<uint32_t> first;
        std::vector<bool> is_bone;
    };
    size_t indexOf(const Eigen::Vector3i& block) const;
    static size_t placeIn(const Eigen::Vector3i& voxel);
    Block& open(const Eigen::Vector3i& block);
    void look(const VoxelVolume& volume, const Eigen::Vector3i& block, Block& out) const;
    // The newest removal not after `now`, or the first one of all.
    std::optional<uint64_t> removalOf(const Eigen::Vector3i& voxel, uint64_t now) const;
    size_t keyOf(const Eigen::Vector3i& voxel) const;

    const VoxelVolume& start_;
    const VoxelVolume& bone_;
    Eigen::Vector3i blocks_;  // per axis
    mutable std::mutex mutex_;
    std::vector<std::unique_ptr<Block>> map_;
    std::unordered_multimap<size_t, uint32_t> again_;  // later removals, by voxel
};

}  // namespace bonemill
