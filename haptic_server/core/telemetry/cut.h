// A cut says where a tick removed or added material. It is trivially copyable and goes to the mesher through
// a bounded ring.
#pragma once

#include <cstdint>
#include <type_traits>

#include "common/rt/spsc_ring.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

struct Cut {
    int64_t start_ns = 0;               // of the tick, CLOCK_MONOTONIC
    int32_t voxels_min[3] = {1, 1, 1};  // box of the voxels that changed, both ends included;
    int32_t voxels_max[3] = {0, 0, 0};  // min > max: none did

    IndexBox voxels() const noexcept {
        return {Eigen::Map<const Eigen::Vector3i>(voxels_min), Eigen::Map<const Eigen::Vector3i>(voxels_max)};
    }
    bool isEmpty() const noexcept { return voxels().isEmpty(); }
};
static_assert(std::is_trivially_copyable_v<Cut>);

inline Cut cutOf(const IndexBox& voxels, int64_t start_ns) noexcept {
    Cut cut;
    cut.start_ns = start_ns;
    Eigen::Map<Eigen::Vector3i>(cut.voxels_min) = voxels.min;
    Eigen::Map<Eigen::Vector3i>(cut.voxels_max) = voxels.max;
    return cut;
}

// Tells the mesher, which reads the ring, if there is anything to tell. RT-safe, for the ring's only
// producer.
inline void tellMesher(SpscRing<Cut>& cuts, const Cut& cut) noexcept {
    if (!cut.isEmpty()) cuts.tryPush(cut);
}

}  // namespace bonemill
