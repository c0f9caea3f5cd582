// One pass over the cells of a leaf: the patches of iso-surface in those that it crosses. RT-safe but for the
// construction; tick thread only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/contact/cell_patch.h"

namespace bonemill {

struct SurfacePatch {
    std::array<uint16_t, 3> cell;  // from the leaf's first cell
    float area;                    // m², > 0
    Eigen::Vector3f centroid;      // cell steps from the cell's first corner
};

class SurfaceCells {
  public:
    // Memory for leaves of up to `leaf_cells` per axis.
    SurfaceCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells);

    // Patches of the cells in `cells`, in ascending order of cells (x fastest). `leaf_first` is the first
    // cell of the leaf that holds them all.
    void collect(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                 const IndexBox& cells) noexcept;

    void clear() noexcept { count_ = 0; }

    std::span<const SurfacePatch> patches() const noexcept { return {patches_.data(), count_}; }

  private:
    void classifyPlane(const VoxelVolume& volume, const IndexBox& cells, int k) noexcept;
    void joinRows(int row, int columns, int k) noexcept;
    void addPatch(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first, const Eigen::Vector3i& cell,
                  int corners_inside) noexcept;
    uint8_t* planeRow(int k, int row) noexcept { return planes_[k & 1].data() + size_t(row) * row_size_; }

    const std::array<CubeTriangles, 256>& triangles_;
    Eigen::Vector3f steps_;  // spacing in units of unit_
    float unit_area_;        // m²
    size_t row_size_;
    std::vector<uint8_t>
        planes_[2];               // is the voxel inside (0 or 1), for the two voxel planes of a cell layer
    std::vector<uint8_t> sides_;  // inside corners of the column's four voxels: bits 0, 2, 4, 6
    std::vector<SurfacePatch> patches_;
    size_t count_ = 0;
};

}  // namespace bonemill
