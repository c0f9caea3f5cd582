// Where a tick removed or added material, on its way to the mesher: trivially copyable, goes through a
// bounded ring.
#pragma once

#include <cstdint>
#include <type_traits>

namespace bonemill {

struct Cut {
    int64_t start_ns = 0;               // of the tick, CLOCK_MONOTONIC
    int32_t voxels_min[3] = {1, 1, 1};  // box of the voxels that changed, both ends included;
    int32_t voxels_max[3] = {0, 0, 0};  // min > max: none did

    bool isEmpty() const noexcept { return voxels_min[0] > voxels_max[0]; }
};
static_assert(std::is_trivially_copyable_v<Cut>);

}  // namespace bonemill
