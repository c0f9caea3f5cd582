// Points of the shell that were just made, side by side. Construction allocates; all else is RT-safe, for the
// tick thread only.
#pragma once

#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/contact/shell_pool.h"
#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {

class FreshPoints {
  public:
    explicit FreshPoints(size_t most)
        : x_(most + kCellLanes), y_(x_), z_(x_), nx_(x_), ny_(x_), nz_(x_), area_(x_) {
        packed_key_.resize(x_.size());
        key_.resize(x_.size());
    }

    void clear() noexcept { count_ = 0; }
    void add(const ShellPoint& point) noexcept {
        BONEMILL_ASSERT(count_ + kCellLanes < x_.size());
        x_[count_] = point.position.x(), y_[count_] = point.position.y(), z_[count_] = point.position.z();
        nx_[count_] = point.normal.x(), ny_[count_] = point.normal.y(), nz_[count_] = point.normal.z();
        area_[count_] = point.area;
        key_[count_] = point.key;
        ++count_;
    }
    // Where a kernel writes points, in place of all that are here; then take() tells how many.
    PackedPoints room() noexcept {
        return {x_.data(),  y_.data(),  z_.data(),    nx_.data(),
                ny_.data(), nz_.data(), area_.data(), packed_key_.data()};
    }
    void take(int count) noexcept {
        count_ = size_t(count);
        for (size_t n = 0; n < count_; ++n) key_[n] = {uint32_t(packed_key_[n])};
    }
    ShellPoints points() const noexcept {
        return {x_.data(),  y_.data(),    z_.data(),   nx_.data(), ny_.data(),
                nz_.data(), area_.data(), key_.data(), count_};
    }

  private:
    std::vector<float> x_, y_, z_, nx_, ny_, nz_, area_;
    std::vector<int> packed_key_;
    std::vector<BlockKey> key_;
    size_t count_ = 0;
};

}  // namespace bonemill
