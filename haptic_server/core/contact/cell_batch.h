// Cells that wait for a kernel that works on many. RT-safe.
#pragma once

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {

class CellBatch {
  public:
    static constexpr int kMost = 64;

    int count() const noexcept { return count_; }
    bool isFull() const noexcept { return count_ == kMost; }
    // It must not be full.
    void add(const CellCorners& corners, int inside) noexcept {
        const auto n = size_t(count_++);
        for (size_t c = 0; c < 8; ++c) excess_[c][n] = corners.excess[c];
        inside_[n] = inside;
    }
    // They stay in memory until others are added.
    CellArrays take() noexcept {
        CellArrays cells;
        for (size_t c = 0; c < 8; ++c) cells.excess[c] = excess_[c];
        cells.inside = inside_;
        cells.count = count_;
        count_ = 0;
        return cells;
    }

  private:
    alignas(64) float excess_[8][kMost];
    alignas(64) int inside_[kMost];
    int count_ = 0;
};
static_assert(CellBatch::kMost % kCellLanes == 0);

}  // namespace bonemill
