// Cells by their indices, side by side as the kernels take them. Construction allocates; all else is RT-safe,
// for one thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {

class CellIndices {
  public:
    explicit CellIndices(size_t most) : i_(most + kCellLanes), j_(i_), k_(i_) {}

    void clear() noexcept { count_ = 0; }
    size_t count() const noexcept { return count_; }
    // It is not checked whether there is room.
    void add(const Eigen::Vector3i& cell) noexcept {
        i_[count_] = cell.x(), j_[count_] = cell.y(), k_[count_] = cell.z();
        ++count_;
    }
    Eigen::Vector3i operator[](size_t n) const noexcept { return {i_[n], j_[n], k_[n]}; }
    // The indices count from `first`.
    CellList list(const Eigen::Vector3i& first = Eigen::Vector3i::Zero()) const noexcept {
        return {i_.data(), j_.data(), k_.data(), {first.x(), first.y(), first.z()}, int(count_)};
    }

  private:
    std::vector<int> i_, j_, k_;
    size_t count_ = 0;
};

}  // namespace bonemill
