#include "haptic_server/contact/surface_cells.h"

#include <algorithm>
#include <cstring>

namespace bonemill {
namespace {

constexpr size_t kWord = sizeof(uint64_t);
constexpr uint64_t kAllInside = 0x5555555555555555;  // kWord columns of four inside voxels

uint64_t wordAt(const uint8_t* bytes) noexcept {
    uint64_t word;
    std::memcpy(&word, bytes, kWord);
    return word;
}

}  // namespace

SurfaceCells::SurfaceCells(const VoxelVolume& volume, const Eigen::Vector3i& leaf_cells)
    : triangles_(cubeTriangles()) {
    const double unit = volume.spacing().maxCoeff();
    steps_ = (volume.spacing() / unit).cast<float>();
    unit_area_ = float(unit * unit);
    row_size_ = size_t(leaf_cells.x()) + 1;
    for (auto& plane : planes_) plane.resize(row_size_ * (size_t(leaf_cells.y()) + 1));
    sides_.resize(row_size_ + kWord);
    patches_.resize(size_t(leaf_cells.x()) * size_t(leaf_cells.y()) * size_t(leaf_cells.z()));
}

void SurfaceCells::collect(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
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
                        addPatch(volume, leaf_first, {cells.min.x() + i, j, k}, inside);
                }
            }
        }
    }
}

void SurfaceCells::classifyPlane(const VoxelVolume& volume, const IndexBox& cells, int k) noexcept {
    const Density iso = volume.iso();
    const int columns = cells.max.x() - cells.min.x() + 2;
    for (int j = cells.min.y(); j <= cells.max.y() + 1; ++j) {
        const Density* voxels = volume.ownerData() + volume.offset(cells.min.x(), j, k);
        uint8_t* inside = planeRow(k, j - cells.min.y());
        for (int i = 0; i < columns; ++i) inside[i] = voxels[i] >= iso;
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

void SurfaceCells::addPatch(const VoxelVolume& volume, const Eigen::Vector3i& leaf_first,
                            const Eigen::Vector3i& cell, int corners_inside) noexcept {
    const CellPatch patch = makePatch(readCorners(volume, cell), triangles_[size_t(corners_inside)], steps_);
    const float area = patch.area * unit_area_;
    if (!(area > 0)) return;
    const Eigen::Vector3i local = cell - leaf_first;
    patches_[count_++] = {
        {uint16_t(local.x()), uint16_t(local.y()), uint16_t(local.z())}, area, patch.centroid};
}

}  // namespace bonemill
