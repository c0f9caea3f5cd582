// Looks at single voxels of a viewer's densities, for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "render_client/link/density_store/density_store.h"

namespace bonemill {

// What a voxel was scanned with, or has now; nothing outside of the grid, or where its brick is not here.
inline std::optional<uint16_t> storedDensity(const DensityStore& store, const Eigen::Vector3i& voxel,
                                             bool is_present) {
    const auto& grid = store.grid();
    if (!grid || (voxel.array() < 0).any() || (voxel.array() >= grid->voxels.array()).any()) return {};
    const uint32_t number = brickOf(*grid, voxel);
    const DensityBrick* const brick = store.find(number);
    if (!brick) return {};
    const Eigen::Vector3i at = voxel - firstVoxelOf(*grid, number);
    const size_t index = size_t(at.x() + grid->brick_edge * (at.y() + grid->brick_edge * at.z()));
    return is_present && !brick->present.empty() ? brick->present[index] : brick->scanned[index];
}
inline std::optional<uint16_t> scannedAt(const DensityStore& store, const Eigen::Vector3i& voxel) {
    return storedDensity(store, voxel, false);
}
inline std::optional<uint16_t> presentAt(const DensityStore& store, const Eigen::Vector3i& voxel) {
    return storedDensity(store, voxel, true);
}

}  // namespace bonemill
