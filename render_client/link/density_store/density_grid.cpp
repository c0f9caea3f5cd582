#include "render_client/link/density_store/density_grid.h"

#include "common/base/assert.h"

namespace bonemill {

Eigen::Vector3i bricksPerAxis(const DensityGrid& grid) {
    return (grid.voxels.array() + (grid.brick_edge - 1)) / grid.brick_edge;
}

int brickCount(const DensityGrid& grid) {
    return bricksPerAxis(grid).prod();
}

uint32_t brickOf(const DensityGrid& grid, const Eigen::Vector3i& voxel) {
    BONEMILL_ASSERT((voxel.array() >= 0).all() && (voxel.array() < grid.voxels.array()).all());
    const Eigen::Vector3i n = bricksPerAxis(grid), at = voxel / grid.brick_edge;
    return uint32_t(at.x() + n.x() * (at.y() + n.y() * at.z()));
}

Eigen::Vector3i firstVoxelOf(const DensityGrid& grid, uint32_t brick) {
    const Eigen::Vector3i n = bricksPerAxis(grid);
    const int b = int(brick);
    BONEMILL_ASSERT(b >= 0 && b < n.prod());
    return Eigen::Vector3i(b % n.x(), b / n.x() % n.y(), b / n.x() / n.y()) * grid.brick_edge;
}

size_t brickVoxels(const DensityGrid& grid) {
    return size_t(grid.brick_edge) * size_t(grid.brick_edge) * size_t(grid.brick_edge);
}

}  // namespace bonemill
