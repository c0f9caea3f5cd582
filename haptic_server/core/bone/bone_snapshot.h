// A snapshot is the bone at one moment, as what differs then from the scanned bone. It never changes once it
// is made; any thread may read.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

// A copy has all voxels of a leaf, x fastest: those of its cells and one more at the upper ends.
struct LeafCopy {
    LeafId leaf;
    uint32_t version;                // of the leaf, even
    std::vector<Density> densities;  // empty: as scanned
};

struct BoneSnapshot {
    std::vector<std::shared_ptr<const LeafCopy>> leaves;  // those that differ; ascending
    int64_t missing_voxels = 0;  // of the scanned bone's voxels at or above the iso-value, net
    uint64_t ticks = 0;          // what the first N ticks of the session milled is in it, and no more

    // These are the leaf's densities; null means as scanned. It is RT-safe.
    const Density* densitiesOf(LeafId leaf) const noexcept {
        const auto found = std::lower_bound(leaves.begin(), leaves.end(), leaf,
                                            [](const auto& copy, LeafId id) { return copy->leaf < id; });
        return found == leaves.end() || (*found)->leaf != leaf ? nullptr : (*found)->densities.data();
    }
};

// Where the voxels of a leaf are in its copy (LeafCopy). RT-safe, for any thread.
inline IndexBox voxelsOf(const IndexBox& cells) noexcept {
    return {cells.min, cells.max.array() + 1};
}

// A voxel has this place in the copy of the leaf with these cells.
inline size_t placeOf(const IndexBox& cells, const Eigen::Vector3i& voxel) noexcept {
    return placeIn(cells.max - cells.min + Eigen::Vector3i::Constant(2), voxel - cells.min);
}

// Calls visit(first voxel) for each row along x of the box.
template <class Visit>
void forEachRow(const IndexBox& voxels, Visit&& visit) noexcept {
    forEachIndex({voxels.min, {voxels.min.x(), voxels.max.y(), voxels.max.z()}}, visit);
}

}  // namespace bonemill
