#include "haptic_server/core/contact/surface_cells.h"

#include <algorithm>

#include "common/base/assert.h"
#include "haptic_server/core/volume/density_view.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {
SurfaceCells::SurfaceCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells)
    : triangles_(packedCubeTriangles()), crossed_(leaf_cells), cells_(size_t(leaf_cells.prod())) {
    const double unit = volume.spacing().maxCoeff();
    steps_ = (volume.spacing() / unit).cast<float>();
    unit_area_ = float(unit * unit);
    const size_t most = size_t(leaf_cells.prod()) + kCellLanes;
    for (auto* values : {&inside_, &all_inside_, &place_, &is_found_}) values->resize(most);
    for (auto& values : excess_) values.resize(most);
    for (auto* values : {&area_, &x_, &y_, &z_, &to_x_, &to_y_, &to_z_, &normal_x_, &normal_y_, &normal_z_})
        values->resize(most);
}

CellArrays SurfaceCells::arrays() const noexcept {
    CellArrays arrays;
    for (int corner = 0; corner < 8; ++corner) arrays.excess[corner] = excess_[corner].data();
    arrays.inside = inside_.data();
    arrays.count = int(cells_.count());
    return arrays;
}

void SurfaceCells::collect(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                           const IndexBox& cells) noexcept {
    findCells(volume, leaf_first, cells);
    kernels().cell_patches(arrays(), triangles_.data(), steps_.data(),
                           {area_.data(), x_.data(), y_.data(), z_.data()});
}

void SurfaceCells::project(const ShellProjection& projection) noexcept {
    const size_t padded = (cells_.count() + kCellLanes - 1) / kCellLanes * kCellLanes;
    std::copy_n(x_.begin(), padded, to_x_.begin());
    std::copy_n(y_.begin(), padded, to_y_.begin());
    std::copy_n(z_.begin(), padded, to_z_.begin());
    kernels().project_into_cells(arrays(), projection.steepness().data(), projection.inverseSpacing().data(),
                                 kProjectionTolerance, kNewtonSteps,
                                 {to_x_.data(), to_y_.data(), to_z_.data(), normal_x_.data(),
                                  normal_y_.data(), normal_z_.data(), is_found_.data()});
}

int SurfaceCells::pack(const ShellProjection& projection, const Eigen::Vector3i& leaf_first,
                       const PackedPoints& out) const noexcept {
    const CellPoints points{area_.data(), unit_area_,       to_x_.data(),     to_y_.data(),
                            to_z_.data(), normal_x_.data(), normal_y_.data(), normal_z_.data()};
    return kernels().pack_points(cells_.list(leaf_first), points, projection.spacing().data(),
                                 BlockKey::kAxisBits, out);
}

void SurfaceCells::findCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                             const IndexBox& cells) noexcept {
    cells_.clear();
    const Eigen::Vector3i size = cells.max - cells.min + Eigen::Vector3i::Ones();
    crossed_.find(
        size,
        [&](int k, size_t row_size, uint8_t* sides) {
            IndexBox layer = cells;
            layer.min.z() = layer.max.z() = cells.min.z() + k;
            // All corners of a brick's own cells are in the brick.
            volume.forEachOwnedPart(layer, [&](const IndexBox& part, size_t offset) {
                const Eigen::Vector3i at = part.min - cells.min, parts = part.max - part.min;
                kernels().cell_sides(
                    {volume.ownerData() + offset, VoxelVolume::kStrideY, VoxelVolume::kStrideZ},
                    parts.x() + 2, parts.y() + 1, volume.iso(), row_size,
                    sides + row_size * size_t(at.y()) + at.x());
            });
        },
        [&](int i, int j, int k, int /*inside*/) {
            cells_.add(cells.min - leaf_first + Eigen::Vector3i(i, j, k));
        });
    ReadCells read{all_inside_.data(), {}, inside_.data(), place_.data()};
    for (size_t c = 0; c < 8; ++c) read.excess[c] = excess_[c].data();
    [[maybe_unused]] const int crossed =
        kernels().read_cells(densityView(volume), cells_.list(leaf_first), read);
    BONEMILL_ASSERT(crossed == int(cells_.count()));
}

}  // namespace bonemill
