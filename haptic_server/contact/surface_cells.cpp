#include "haptic_server/contact/surface_cells.h"

#include <algorithm>

#include "haptic_server/contact/shell_point.h"
#include "haptic_server/volume/marching_cubes_table.h"

namespace bonemill {
namespace {

// As the kernel wants them.
std::vector<int> packedTriangles() {
    static_assert(kMaxCubeTriangles == kTrianglesPerCell);
    std::vector<int> packed(256 * kTrianglesPerCell, 0);
    for (size_t inside = 0; inside < 256; ++inside) {
        const CubeTriangles& triangles = cubeTriangles()[inside];
        for (size_t n = 0; n < triangles.count; ++n) {
            const auto& [a, b, c] = triangles.edges[n];
            packed[inside * kTrianglesPerCell + n] = a | b << 4 | c << 8;
        }
    }
    return packed;
}

}  // namespace

SurfaceCells::SurfaceCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells)
    : triangles_(packedTriangles()), crossed_(leaf_cells) {
    const double unit = volume.spacing().maxCoeff();
    steps_ = (volume.spacing() / unit).cast<float>();
    unit_area_ = float(unit * unit);
    copied_.resize(size_t((leaf_cells.array() + 1).prod()) + VoxelVolume::kReadSlack);
    const size_t most = size_t(leaf_cells.prod()) + kCellLanes;
    cell_.resize(most);
    inside_.resize(most);
    is_found_.resize(most);
    for (auto& values : excess_) values.resize(most);
    for (auto* values : {&area_, &x_, &y_, &z_, &to_x_, &to_y_, &to_z_, &normal_x_, &normal_y_, &normal_z_})
        values->resize(most);
}

CellArrays SurfaceCells::arrays() const noexcept {
    CellArrays arrays;
    for (int corner = 0; corner < 8; ++corner) arrays.excess[corner] = excess_[corner].data();
    arrays.inside = inside_.data();
    arrays.count = int(count_);
    return arrays;
}

void SurfaceCells::collect(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                           const IndexBox& cells) noexcept {
    findCells(volume, leaf_first, cells);
    kernels().cell_patches(arrays(), triangles_.data(), steps_.data(),
                           {area_.data(), x_.data(), y_.data(), z_.data()});
}

void SurfaceCells::project(const ShellProjection& projection) noexcept {
    const size_t padded = (count_ + kCellLanes - 1) / kCellLanes * kCellLanes;
    std::copy_n(x_.begin(), padded, to_x_.begin());
    std::copy_n(y_.begin(), padded, to_y_.begin());
    std::copy_n(z_.begin(), padded, to_z_.begin());
    kernels().project_into_cells(arrays(), projection.steepness().data(), projection.inverseSpacing().data(),
                                 kProjectionTolerance, kNewtonSteps,
                                 {to_x_.data(), to_y_.data(), to_z_.data(), normal_x_.data(),
                                  normal_y_.data(), normal_z_.data(), is_found_.data()});
}

void SurfaceCells::findCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                             const IndexBox& cells) noexcept {
    count_ = 0;
    const Eigen::Vector3i size = cells.max - cells.min + Eigen::Vector3i::Ones();
    const Eigen::Vector3i from_leaf_first = cells.min - leaf_first;
    const VoxelBox box = cornersOf(volume, cells);
    crossed_.find(box, size, volume.iso(), [&](int i, int j, int k, int inside) {
        const Density* first_corner = box.first + i + box.stride_y * size_t(j) + box.stride_z * size_t(k);
        addCell(from_leaf_first + Eigen::Vector3i(i, j, k), first_corner, box, volume.iso(), inside);
    });
}

VoxelBox SurfaceCells::cornersOf(const VoxelVolume& volume, const IndexBox& cells) noexcept {
    const IndexBox voxels{cells.min, cells.max.array() + 1};
    if (const Density* first = volume.inOneBrick(voxels))
        return {first, VoxelVolume::kStrideY, VoxelVolume::kStrideZ};
    const Eigen::Vector3i size = voxels.max - voxels.min + Eigen::Vector3i::Ones();
    Density* row = copied_.data();
    for (int k = 0; k < size.z(); ++k)
        for (int j = 0; j < size.y(); ++j, row += size.x())
            volume.readRow(voxels.min + Eigen::Vector3i(0, j, k), size.x(), row);
    return {copied_.data(), size_t(size.x()), size_t(size.x()) * size_t(size.y())};
}

void SurfaceCells::addCell(const Eigen::Vector3i& from_leaf_first, const Density* first_corner,
                           const VoxelBox& box, Density iso, int corners_inside) noexcept {
    const size_t y = box.stride_y, z = box.stride_z;
    const size_t corners[] = {0, 1, y, y + 1, z, z + 1, z + y, z + y + 1};
    for (size_t c = 0; c < 8; ++c) excess_[c][count_] = float(first_corner[corners[c]] - iso);
    cell_[count_] = {uint16_t(from_leaf_first.x()), uint16_t(from_leaf_first.y()),
                     uint16_t(from_leaf_first.z())};
    inside_[count_++] = corners_inside;
}

}  // namespace bonemill
