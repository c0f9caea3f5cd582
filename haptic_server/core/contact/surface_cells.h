// One pass over the cells of a leaf finds the patches of iso-surface in those that it crosses. It is RT-safe
// but for the construction, and for the tick thread only.
#pragma once

#include <vector>

#include "haptic_server/core/contact/cell_indices.h"
#include "haptic_server/core/contact/shell_point.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/crossed_cells.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

class SurfaceCells {
  public:
    // Memory for leaves of up to `leaf_cells` per axis.
    SurfaceCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells);

    // Collects the cells of `cells` that the surface crosses, in ascending order (x fastest), with their
    // patches. `leaf_first` is the first cell of the leaf that holds them all.
    void collect(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                 const IndexBox& cells) noexcept;
    size_t count() const noexcept { return cells_.count(); }

    // The cell is counted from the leaf's first one.
    Eigen::Vector3i cell(size_t n) const noexcept { return cells_[n]; }
    // The area is in m², and zero where the surface only touches a voxel.
    float area(size_t n) const noexcept { return area_[n] * unit_area_; }
    // They are cell steps from the cell's first corner, of patches with an area.
    Eigen::Vector3f centroid(size_t n) const noexcept { return {x_[n], y_[n], z_[n]}; }

    // Finds a place of each cell's trilinear iso-surface, from the patch's centroid;
    // see ShellProjection::walk().
    void project(const ShellProjection& projection) noexcept;
    bool isFound(size_t n) const noexcept { return is_found_[n] != 0; }
    // The place is in cell steps.
    Eigen::Vector3f projected(size_t n) const noexcept { return {to_x_[n], to_y_[n], to_z_[n]}; }
    // Replaces what project() found for that cell; isFound() stays.
    void put(size_t n, const Eigen::Vector3f& at, const Eigen::Vector3f& normal) noexcept {
        to_x_[n] = at.x(), to_y_[n] = at.y(), to_z_[n] = at.z();
        normal_x_[n] = normal.x(), normal_y_[n] = normal.y(), normal_z_[n] = normal.z();
    }
    // Writes the points of the cells whose patches have an area, with places and normals as project() found
    // or put() replaced them. Returns how many.
    int pack(const ShellProjection& projection, const Eigen::Vector3i& leaf_first,
             const PackedPoints& out) const noexcept;

  private:
    void findCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                   const IndexBox& cells) noexcept;
    CellArrays arrays() const noexcept;

    std::vector<int> triangles_;  // of each set of inside corners
    Eigen::Vector3f steps_;       // spacing in units of unit_
    float unit_area_;             // m²
    CrossedCells crossed_;

    CellIndices cells_;
    std::vector<int> inside_;              // which corners are inside the bone
    std::vector<int> all_inside_, place_;  // scratch: the kernel tells of cells that are not crossed, too
    std::vector<float> excess_[8];         // density minus iso at the corners, counts
    std::vector<float> area_, x_, y_, z_;
    std::vector<float> to_x_, to_y_, to_z_, normal_x_, normal_y_, normal_z_;
    std::vector<int> is_found_;
};

}  // namespace bonemill
