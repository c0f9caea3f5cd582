// Says how much may be written now, so that the mean stays below a rate. It is for one thread.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/rt/clock.h"

namespace bonemill {

class ByteBudget {
  public:
    static constexpr double kBurst_s = 0.05;  // of saved-up allowance at most

    explicit ByteBudget(double bytes_per_s) : bytes_per_s_(bytes_per_s) {}

    // It is negative after more was spent than there was, for a whole group may be larger than what is left.
    int64_t available(int64_t now_ns) {
        if (last_ns_ != 0) allowance_ += bytes_per_s_ * secondsOfNs(now_ns - last_ns_);
        allowance_ = std::min(allowance_, bytes_per_s_ * kBurst_s);
        last_ns_ = now_ns;
        return int64_t(allowance_);
    }
    void spend(size_t bytes) { allowance_ -= double(bytes); }

  private:
    double bytes_per_s_;
    double allowance_ = 0;
    int64_t last_ns_ = 0;
};

}  // namespace bonemill
