// Says how much of each cell is bone: the volume behind the surface that is drawn (marching cubes). What is
// bone on a face only depends on the face, as for the triangles: the cells' volumes add up to that of the
// closed surface.
//
// Construction allocates; all else is RT-safe, for one thread.
#pragma once

#include <algorithm>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/density_view.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {

class CellFills {
  public:
    static constexpr int kAllInside = 255;

    CellFills() : triangles_(packedCubeTriangles()) {
        for (size_t c = 0; c < 8; ++c) crossed_.excess[c] = excess_[c];
    }
    CellFills(const CellFills&) = delete;
    CellFills& operator=(const CellFills&) = delete;

    // Writes the share of each cell that is bone, 0 .. 1, and which of its corners are inside, bit by corner.
    // There is room for kCellLanes more.
    void measure(const VoxelVolume& volume, const CellList& cells, float* fills, int* inside) noexcept {
        const DensityView density = densityView(volume);
        for (int first = 0; first < cells.count; first += kBatch) {
            CellList batch = cells;
            batch.i += first, batch.j += first, batch.k += first;
            batch.count = std::min(kBatch, cells.count - first);
            measureBatch(density, batch, fills + first, inside + first);
        }
    }

  private:
    static constexpr int kBatch = 256, kRoom = kBatch + kCellLanes;

    void measureBatch(const DensityView& density, const CellList& cells, float* fills, int* inside) noexcept {
        crossed_.inside = inside;
        CellArrays crossed{{}, crossed_inside_, kernels().read_cells(density, cells, crossed_)};
        for (size_t c = 0; c < 8; ++c) crossed.excess[c] = excess_[c];
        kernels().cell_fills(crossed, triangles_.data(), crossed_fills_);
        for (int n = 0; n < cells.count; ++n) fills[n] = inside[n] == kAllInside ? 1 : 0;
        for (int n = 0; n < crossed.count; ++n) fills[place_[n]] = crossed_fills_[n];
    }

    std::vector<int> triangles_;
    alignas(64) float excess_[8][kRoom];
    alignas(64) float crossed_fills_[kRoom];
    int crossed_inside_[kRoom], place_[kRoom];
    ReadCells crossed_{.inside = nullptr, .excess = {}, .crossed_inside = crossed_inside_, .place = place_};
};

}  // namespace bonemill
