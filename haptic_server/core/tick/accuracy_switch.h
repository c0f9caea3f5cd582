// With this other threads tell the tick to compute with other accuracy settings from now on.
#pragma once

#include <array>
#include <atomic>

#include "haptic_server/core/accuracy/accuracy_settings.h"

namespace bonemill {

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
