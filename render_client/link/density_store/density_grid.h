// The grid of the scan's voxels, cut into bricks of equal edge. It is for any thread.
//
// Voxel (i, j, k) lies at origin_m + spacing_m ∘ (i, j, k) in the volume frame V (docs/develop/frames.md).
// Bricks are numbered x fastest; the last ones of an axis may reach beyond the grid.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace bonemill {

struct DensityGrid {
    Eigen::Vector3i voxels;     // per axis, at least 1
    Eigen::Vector3d spacing_m;  // > 0
    Eigen::Vector3d origin_m;   // of voxel (0, 0, 0), in V
    int brick_edge;             // voxels, at least 1
    double value_at_0;          // of the scan at density 0, HU where it is CT
    double value_at_65535;      // of the scan at density 65535
    double iso_value;           // of the bone surface, as the two above
    bool operator==(const DensityGrid&) const = default;
};

Eigen::Vector3i bricksPerAxis(const DensityGrid& grid);
int brickCount(const DensityGrid& grid);
// The voxel must be one of the grid.
uint32_t brickOf(const DensityGrid& grid, const Eigen::Vector3i& voxel);
// Returns the brick's first voxel. The brick must be one of the grid.
Eigen::Vector3i firstVoxelOf(const DensityGrid& grid, uint32_t brick);
// Returns how many voxels a brick holds, those beyond the grid included.
size_t brickVoxels(const DensityGrid& grid);

}  // namespace bonemill
