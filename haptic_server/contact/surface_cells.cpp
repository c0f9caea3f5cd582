#include "haptic_server/contact/surface_cells.h"

#include <algorithm>
#include <cstring>

#include "haptic_server/contact/cell_corners.h"
#include "haptic_server/contact/shell_point.h"
#include "haptic_server/volume/marching_cubes_table.h"

namespace bonemill {
namespace {

constexpr size_t kWord = sizeof(uint64_t);
constexpr uint64_t kAllInside = 0x5555555555555555;  // kWord columns of four inside voxels

uint64_t wordAt(const uint8_t* bytes) noexcept {
    uint64_t word;
    std::memcpy(&word, bytes, kWord);
    return word;
}

std::vector<int> triangleEdges() {
    std::vector<int> edges(256 * kTriangleStride, 0);
    for (size_t inside = 0; inside < 256; ++inside) {
        const CubeTriangles& triangles = cubeTriangles()[inside];
        for (size_t n = 0; n < triangles.count; ++n)
            for (size_t v = 0; v < 3; ++v)
                edges[inside * kTriangleStride + 3 * n + v] = triangles.edges[n][v];
    }
    return edges;
}

}  // namespace

SurfaceCells::SurfaceCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells)
    : triangle_edges_(triangleEdges()) {
    const double unit = volume.spacing().maxCoeff();
    steps_ = (volume.spacing() / unit).cast<float>();
    unit_area_ = float(unit * unit);
    row_size_ = size_t(leaf_cells.x()) + 1;
    for (auto& plane : planes_) plane.resize(row_size_ * (size_t(leaf_cells.y()) + 1));
    sides_.resize(row_size_ + kWord);
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
    kernels().cell_patches(arrays(), triangle_edges_.data(), steps_.data(),
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
    const int columns = cells.max.x() - cells.min.x() + 2;
    classifyPlane(volume, cells, cells.min.z());
    for (int k = cells.min.z(); k <= cells.max.z(); ++k) {
        classifyPlane(volume, cells, k + 1);
        for (int j = cells.min.y(); j <= cells.max.y(); ++j) {
            joinRows(j - cells.min.y(), columns, k);
            for (int i = 0; i + 1 < columns;) {
                // Cells i .. i + 6 lie between the columns i .. i + 7; columns beyond the row repeat its
                // last.
                const uint64_t word = wordAt(&sides_[size_t(i)]);
                if (word == 0 || word == kAllInside) {
                    i += int(kWord) - 1;
                    continue;
                }
                const int end = std::min(i + int(kWord) - 1, columns - 1);
                for (; i < end; ++i) {
                    const int inside = sides_[size_t(i)] | sides_[size_t(i) + 1] << 1;
                    if (inside != 0 && inside != 255)
                        addCell(volume, leaf_first, {cells.min.x() + i, j, k}, inside);
                }
            }
        }
    }
}

void SurfaceCells::classifyPlane(const VoxelVolume& volume, const IndexBox& cells, int k) noexcept {
    const Density iso = volume.iso();
    const int columns = cells.max.x() - cells.min.x() + 2;
    for (int j = cells.min.y(); j <= cells.max.y() + 1; ++j) {
        uint8_t* inside = planeRow(k, j - cells.min.y());
        volume.forEachRun({cells.min.x(), j, k}, columns, [&](size_t offset, int count) {
            const Density* voxels = volume.ownerData() + offset;
            for (int i = 0; i < count; ++i) inside[i] = voxels[i] >= iso;
            inside += count;
        });
    }
}

void SurfaceCells::joinRows(int row, int columns, int k) noexcept {
    const uint8_t* near_low = planeRow(k, row);
    const uint8_t* near_high = planeRow(k, row + 1);
    const uint8_t* far_low = planeRow(k + 1, row);
    const uint8_t* far_high = planeRow(k + 1, row + 1);
    uint8_t* sides = sides_.data();
    for (int i = 0; i < columns; ++i)
        sides[i] = uint8_t(near_low[i] + 4 * near_high[i] + 16 * far_low[i] + 64 * far_high[i]);
    std::memset(sides + columns, sides[columns - 1], kWord);
}

void SurfaceCells::addCell(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                           const Eigen::Vector3i& cell, int corners_inside) noexcept {
    const CellCorners corners = readCorners(volume, cell);
    for (size_t c = 0; c < 8; ++c) excess_[c][count_] = corners.excess[c];
    const Eigen::Vector3i local = cell - leaf_first;
    cell_[count_] = {uint16_t(local.x()), uint16_t(local.y()), uint16_t(local.z())};
    inside_[count_++] = corners_inside;
}

}  // namespace bonemill
