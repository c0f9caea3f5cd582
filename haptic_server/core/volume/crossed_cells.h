// Finds the cells of a box that the iso-surface crosses, layer by layer. Owns its scratch memory.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {

// It is RT-safe but for the construction, as far as the callers' functions are, and for one thread at a time.
class CrossedCells {
  public:
    // There is room for boxes of up to `most_cells` per axis.
    explicit CrossedCells(const Eigen::Vector3i& most_cells)
        : sides_(rowSize(most_cells.x()) * size_t(most_cells.y())) {}

    // Calls visit(i, j, k, inside) for the crossed ones of a box of `cells` per axis, x fastest; `inside` has
    // a bit for each corner c, at (c & 1, c >> 1 & 1, c >> 2 & 1), whose density is iso or more.
    // look(k, row_size, sides) fills the sides of layer k by kernels().cell_sides, from the first row and
    // column on; what is looked at piece by piece, in ascending order of x.
    template <class Look, class Visit>
    void find(const Eigen::Vector3i& cells, Look&& look, Visit&& visit) {
        const size_t row_size = rowSize(cells.x());
        for (int k = 0; k < cells.z(); ++k) {
            look(k, row_size, sides_.data());
            for (int j = 0; j < cells.y(); ++j)
                visitRow(sides_.data() + row_size * size_t(j), cells.x(),
                         [&](int i, int inside) { visit(i, j, k, inside); });
        }
    }

  private:
    // A row has one column more than cells, and what the kernel writes behind them.
    static size_t rowSize(int cells) noexcept { return size_t(cells) + 1 + kCellLanes; }
    static constexpr uint64_t kAllInside = 0x5555555555555555;  // columns of four inside voxels

    // Cells i .. i + 6 lie between the columns i .. i + 7.
    template <class Visit>
    static void visitRow(const uint8_t* sides, int cells, Visit&& visit) {
        for (int i = 0; i < cells;) {
            uint64_t word;
            static_assert(sizeof word == kCellsAtOnce);
            std::memcpy(&word, sides + i, sizeof word);
            if (word == 0 || word == kAllInside) {
                i += kCellsAtOnce - 1;
                continue;
            }
            const int end = std::min(i + kCellsAtOnce - 1, cells);
            for (; i < end; ++i) {
                const int inside = sides[i] | sides[i + 1] << 1;
                if (inside != 0 && inside != 255) visit(i, inside);
            }
        }
    }

    std::vector<uint8_t> sides_;  // of one layer's columns
};

}  // namespace bonemill
