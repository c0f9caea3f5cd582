// Says how much of each cell is bone: the volume behind the surface that is drawn (marching cubes). What is
// bone on a face only depends on the face, as for the triangles: the cells' volumes add up to that of the
// closed surface.
//
// Construction allocates; all else is RT-safe, for one thread.
#pragma once

#include <utility>
#include <vector>

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {

class CellFills {
  public:
    static constexpr int kMost = 64;

    CellFills() : triangles_(packedCubeTriangles()) {}

    bool isFull() const noexcept { return count_ == kMost; }
    // Adds a cell; it must not be full.
    void add(const CellCorners& corners) noexcept {
        const auto n = size_t(count_++);
        int inside = 0;
        for (size_t c = 0; c < 8; ++c) {
            excess_[c][n] = corners.excess[c];
            inside |= int(corners.excess[c] >= 0) << c;
        }
        inside_[n] = inside;
    }
    // Forgets the cells that were added, and calls visit(n, fill) with the share of each that is bone, 0
    // .. 1.
    template <class Visit>
    void take(Visit&& visit) noexcept {
        CellArrays cells;
        for (size_t c = 0; c < 8; ++c) cells.excess[c] = excess_[c];
        cells.inside = inside_;
        cells.count = std::exchange(count_, 0);
        alignas(64) float fills[kMost];
        kernels().cell_fills(cells, triangles_.data(), fills);
        for (int n = 0; n < cells.count; ++n) visit(n, fills[n]);
    }

  private:
    std::vector<int> triangles_;
    alignas(64) float excess_[8][kMost];
    alignas(64) int inside_[kMost];
    int count_ = 0;
};

}  // namespace bonemill
