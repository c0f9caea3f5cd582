#include "haptic_server/core/effects/thermal/dead_cells.h"

#include <algorithm>

namespace bonemill {

DeadCells::DeadCells(const Eigen::Vector3i& bricks, size_t most_bricks)
    : bricks_(bricks), directory_(size_t(bricks.prod()), kNone) {
    pool_.resize(std::min(most_bricks, directory_.size()));
}

void DeadCells::add(const Eigen::Vector3i& brick, int cell) noexcept {
    uint32_t slot = slotOf(brick);
    if (slot == kNone) {
        if (used_ == pool_.size()) return;
        slot = directory_[directoryIndex(brick)] = uint32_t(used_++);
        pool_[slot] = {.is_dead = {}, .index = brick, .is_stale = false};
    }
    auto is_dead = pool_[slot].is_dead[size_t(cell)];
    count_ += !is_dead;
    is_dead = true;
}

void DeadCells::remove(const Eigen::Vector3i& brick, int cell) noexcept {
    const uint32_t slot = slotOf(brick);
    if (slot == kNone) return;
    auto is_dead = pool_[slot].is_dead[size_t(cell)];
    count_ -= is_dead;
    is_dead = false;
}

void DeadCells::forget() noexcept {
    used_ = count_ = stale_ = next_ = 0;
}

void DeadCells::noteChange(const Eigen::Vector3i& brick) noexcept {
    const uint32_t slot = slotOf(brick);
    if (slot != kNone) markStale(slot, slot + 1);
}

uint32_t DeadCells::slotOf(const Eigen::Vector3i& brick) const noexcept {
    const uint32_t slot = directory_[directoryIndex(brick)];
    return slot < used_ && pool_[slot].index == brick ? slot : kNone;
}

void DeadCells::markStale(size_t first, size_t end) noexcept {
    for (size_t slot = first; slot < end; ++slot) {
        stale_ += !pool_[slot].is_stale;
        pool_[slot].is_stale = true;
    }
}

}  // namespace bonemill
