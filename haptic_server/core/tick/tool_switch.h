// With this other threads tell the tick to work with another tool from now on.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

// The tools, at least one, are all built at the start. Their models must outlive the switch.
class ToolSwitch {
  public:
    explicit ToolSwitch(std::vector<SpoTool> tools, size_t first = 0)
        : tools_(std::move(tools)), choice_(first) {
        BONEMILL_ASSERT(first < tools_.size());
    }

    // Any thread may call both; index < count(). Relaxed is enough, for the tools themselves never change.
    void choose(size_t index) noexcept {
        BONEMILL_ASSERT(index < count());
        choice_.store(index, std::memory_order_relaxed);
    }
    size_t chosen() const noexcept { return choice_.load(std::memory_order_relaxed); }

    size_t count() const noexcept { return tools_.size(); }
    std::span<const SpoTool> all() const noexcept { return tools_; }
    const SpoTool& operator[](size_t index) const noexcept {
        BONEMILL_ASSERT(index < count());
        return tools_[index];
    }
    double largestBurrRadius() const noexcept {
        return std::max_element(
                   tools_.begin(), tools_.end(),
                   [](const SpoTool& a, const SpoTool& b) { return a.burr.radius < b.burr.radius; })
            ->burr.radius;
    }
    double largestBurrReach() const noexcept {
        return std::max_element(
                   tools_.begin(), tools_.end(),
                   [](const SpoTool& a, const SpoTool& b) { return a.burr.reach() < b.burr.reach(); })
            ->burr.reach();
    }

  private:
    std::vector<SpoTool> tools_;
    std::atomic<size_t> choice_;
};

}  // namespace bonemill
