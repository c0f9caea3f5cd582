// The last place before a vendor's library: what leaves it is finite, no larger than the arm's limits, and
// comes and goes in 20 ms.
//
// It is RT-safe, for one thread.
#pragma once

#include <algorithm>
#include <optional>

#include "common/geometry/bounded_vector.h"

namespace bonemill::bridge {

class ForceGate {
  public:
    explicit ForceGate(const WrenchNorms& norms) noexcept : norms_(norms) {}

    // `wanted` is nothing where no force is allowed: then the last wrench fades. `elapsed` s have passed
    // since the last call.
    Wrench step(const std::optional<Wrench>& wanted, double elapsed) noexcept;
    bool isClosed() const noexcept { return opening_ == 0; }

    static constexpr double kFadeTime = 0.02;  // s

  private:
    const WrenchNorms norms_;
    Wrench held_;
    double opening_ = 0;  // 0 closed, 1 open
};

inline Wrench ForceGate::step(const std::optional<Wrench>& wanted, double elapsed) noexcept {
    const bool is_allowed = wanted && wanted->isFinite();
    if (is_allowed) held_ = bounded(*wanted, norms_);
    const double change = std::max(0.0, elapsed) / kFadeTime;
    opening_ = std::clamp(opening_ + (is_allowed ? change : -change), 0.0, 1.0);
    if (isClosed()) held_ = {};
    return {held_.force * opening_, held_.torque * opening_};
}

}  // namespace bonemill::bridge
