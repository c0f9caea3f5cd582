// With this another thread tunes the contact law while ticks go on: stiffness and damping of the coupling,
// the contact's stiffness, and what the hand may feel.
//
// What was tuned once never changes: it has a number, by which a recording knows it, too. A tick asks for the
// number once, and takes up another one as it takes up another device: at a limited rate of the force
// (hand_limits.h), within what the device in the hand carries (hand_coupling.h), and with a new account of
// the energy. Without a tuning the question is all that it costs.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/coupling/thesis_2012_coupling.h"
#include "haptic_server/core/tick/hand_limits.h"

namespace bonemill {

// As in TickConfig: `hand` is at the hand, all else at the tool.
struct TickTuning {
    CouplingConfig thesis;
    EnergyCouplingConfig gradient;
    GradientContactConfig contact;
    HandLimitsConfig hand;
    std::vector<double> saturation_forces;  // N, SpoTool::saturation_force of each tool
};

class TuningSwitch {
  public:
    static constexpr uint32_t kOfScene = 0;
    static constexpr uint32_t kMost = 1000;  // tunings besides the scene's own

    explicit TuningSwitch(TickTuning of_scene) {
        all_[kOfScene] = std::make_unique<const TickTuning>(std::move(of_scene));
    }

    // One normal thread adds them, and may choose any of them from then on; it allocates. Returns the number;
    // kOfScene says that there is no room for another.
    uint32_t add(TickTuning tuning) {
        if (count() > kMost) return kOfScene;
        all_[count_] = std::make_unique<const TickTuning>(std::move(tuning));
        return count_++;
    }
    uint32_t count() const noexcept { return count_; }

    // That thread chooses; any thread may ask. Whoever sees the number sees what it stands for (release and
    // acquire).
    void choose(uint32_t number) noexcept {
        BONEMILL_ASSERT(number < count());
        chosen_.store(number, std::memory_order_release);
    }
    uint32_t chosen() const noexcept { return chosen_.load(std::memory_order_acquire); }
    // Of a number that was chosen, or is.
    const TickTuning& operator[](uint32_t number) const noexcept { return *all_[number]; }

  private:
    std::array<std::unique_ptr<const TickTuning>, kMost + 1> all_;
    uint32_t count_ = 1;  // of the thread that adds
    std::atomic<uint32_t> chosen_{kOfScene};
};

}  // namespace bonemill
