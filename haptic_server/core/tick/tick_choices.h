// With these other threads tell the tick to work with another tool, or to compute with other accuracy
// settings, from now on.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/accuracy/accuracy_settings.h"
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

// The choice is fixed: what the scene says, and the presets, the compared laws among them.
class AccuracySwitch {
  public:
    static constexpr size_t kSceneChoice = 0;

    explicit AccuracySwitch(const AccuracySettings& of_scene) noexcept {
        choices_[kSceneChoice] = of_scene;
        for (const Preset preset : allPresets()) choices_[choiceOf(preset)] = presetSettings(preset);
    }

    static constexpr size_t choiceOf(Preset preset) noexcept { return 1 + size_t(preset); }

    // Any thread may call all of them. Relaxed is enough, for the choices themselves never change.
    void choose(size_t choice) noexcept { choice_.store(choice, std::memory_order_relaxed); }
    size_t choice() const noexcept { return choice_.load(std::memory_order_relaxed); }
    const AccuracySettings& chosen() const noexcept { return choices_[choice()]; }
    // All of them, by choice.
    static constexpr size_t count() noexcept { return 1 + kPresetCount; }
    const AccuracySettings& operator[](size_t choice) const noexcept { return choices_[choice]; }

  private:
    std::array<AccuracySettings, 1 + kPresetCount> choices_;
    std::atomic<size_t> choice_{kSceneChoice};
};

}  // namespace bonemill
