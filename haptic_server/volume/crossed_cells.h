// Finds the cells of a box that the iso-surface crosses, row by row of voxels. Owns its scratch memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "haptic_server/kernels/kernels.h"
#include "haptic_server/volume/brick_store.h"

namespace bonemill {

// RT-safe but for the construction, as far as the visitor is; one thread at a time.
class CrossedCells {
  public:
    // For boxes of up to `most_cells` per axis.
    explicit CrossedCells(const Eigen::Vector3i& most_cells) : row_size_(size_t(most_cells.x()) + 1) {
        for (auto& plane : planes_) plane.resize(row_size_ * (size_t(most_cells.y()) + 1));
        sides_.resize(row_size_ + kWord);
    }

    // Calls visit(i, j, k, inside) for the crossed ones of a box of `cells` per axis, x fastest; `inside` has
    // a bit for each corner c, at (c & 1, c >> 1 & 1, c >> 2 & 1), whose density is iso or more. runs(j, k,
    // visit_run) calls visit_run(densities, count) for the runs that make up this row of cells.x() + 1
    // voxels.
    template <class Runs, class Visit>
    void find(const Eigen::Vector3i& cells, Density iso, Runs&& runs, Visit&& visit) {
        classifyPlane(cells, 0, iso, runs);
        for (int k = 0; k < cells.z(); ++k) {
            classifyPlane(cells, k + 1, iso, runs);
            for (int j = 0; j < cells.y(); ++j) {
                joinRows(cells, j, k);
                visitRow(cells.x(), [&](int i, int inside) { visit(i, j, k, inside); });
            }
        }
    }

  private:
    static constexpr size_t kWord = sizeof(uint64_t);
    static constexpr uint64_t kAllInside = 0x5555555555555555;  // kWord columns of four inside voxels

    uint8_t* planeRow(int j, int k) noexcept { return planes_[k & 1].data() + size_t(j) * row_size_; }

    template <class Runs>
    void classifyPlane(const Eigen::Vector3i& cells, int k, Density iso, Runs& runs) noexcept {
        for (int j = 0; j <= cells.y(); ++j) {
            uint8_t* inside = planeRow(j, k);
            runs(j, k, [&](const Density* densities, int count) {
                kernels().at_least(densities, count, iso, inside);
                inside += count;
            });
        }
    }

    void joinRows(const Eigen::Vector3i& cells, int j, int k) noexcept {
        const size_t columns = size_t(cells.x()) + 1;
        kernels().join_rows(planeRow(j, k), planeRow(j + 1, k), planeRow(j, k + 1), planeRow(j + 1, k + 1),
                            int(columns), sides_.data());
        std::memset(sides_.data() + columns, sides_[columns - 1], kWord);
    }

    template <class Visit>
    void visitRow(int cells, Visit&& visit) {
        for (int i = 0; i < cells;) {
            // Cells i .. i + 6 lie between the columns i .. i + 7; columns beyond the row repeat its last.
            uint64_t word;
            std::memcpy(&word, &sides_[size_t(i)], kWord);
            if (word == 0 || word == kAllInside) {
                i += int(kWord) - 1;
                continue;
            }
            const int end = std::min(i + int(kWord) - 1, cells);
            for (; i < end; ++i) {
                const int inside = sides_[size_t(i)] | sides_[size_t(i) + 1] << 1;
                if (inside != 0 && inside != 255) visit(i, inside);
            }
        }
    }

    size_t row_size_;
    std::vector<uint8_t>
        planes_[2];               // is the voxel inside (0 or 1), for the two voxel planes of a cell layer
    std::vector<uint8_t> sides_;  // inside corners of the column's four voxels: bits 0, 2, 4, 6
};

}  // namespace bonemill
