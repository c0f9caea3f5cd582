// Says how much of each cell is bone: the volume behind the surface that is drawn (marching cubes). What is
// bone on a face only depends on the face, as for the triangles: the cells' volumes add up to that of the
// closed surface.
//
// Construction allocates; all else is RT-safe, for one thread.
#pragma once

#include <vector>

#include "haptic_server/core/contact/cell_batch.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {

class CellFills {
  public:
    static constexpr int kMost = CellBatch::kMost;

    CellFills() : triangles_(packedCubeTriangles()) {}

    int count() const noexcept { return cells_.count(); }
    bool isFull() const noexcept { return cells_.isFull(); }
    // Adds a cell with these corners inside; it must not be full.
    void add(const CellCorners& corners, int inside) noexcept { cells_.add(corners, inside); }
    // Forgets the cells that were added, and calls visit(n, fill) with the share of each that is bone, 0
    // .. 1.
    template <class Visit>
    void take(Visit&& visit) noexcept {
        const CellArrays cells = cells_.take();
        alignas(64) float fills[kMost];
        kernels().cell_fills(cells, triangles_.data(), fills);
        for (int n = 0; n < cells.count; ++n) visit(n, fills[n]);
    }

  private:
    std::vector<int> triangles_;
    CellBatch cells_;
};

}  // namespace bonemill
