// The tick and the contact model call the effects of a scene through this. If none is listed, nothing
// is called.
#pragma once

#include <memory>
#include <vector>

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

using EffectList = std::vector<std::unique_ptr<HapticEffect>>;

class EffectHost final : private ContactWeights, private SolveEnergy {
  public:
    // Allocates room for the contacts of `most_candidates`; κ is in N/m³.
    EffectHost(EffectList effects, size_t most_candidates, double stiffness_per_area);

    // The contact model takes these; null means that no effect needs it. They live as long as the host.
    ContactWeights* weights() noexcept {
        return any(HapticEffect::kScales | HapticEffect::kReadsContacts) ? this : nullptr;
    }
    // κ is another one from now on.
    void setStiffness(double stiffness_per_area) noexcept { stiffness_per_area_ = stiffness_per_area; }
    SolveEnergy* energy() noexcept { return any(HapticEffect::kHasEnergy) ? this : nullptr; }

    // The phases of a tick come in this order. Each is RT-safe, for the tick thread only.
    void restart(Restart why) noexcept;
    void begin(const EffectStart& start) noexcept;
    void addToHand(Wrench& wrench_V) noexcept;
    // Tells, after the force went out, where the solve ended and what its contacts are.
    void afterSolve(const Pose& X_VT, SpoModel& model) noexcept;
    void mill(BoneModel& bone, MillingResult& result) noexcept;
    // Without time for it heat waits for the next tick.
    const EffectRecord& finish(bool has_time) noexcept;

    bool isEmpty() const noexcept { return effects_.empty(); }

  private:
    bool any(uint32_t needs) const noexcept { return needs_ & needs; }
    double scale(Candidates& candidates, const Eigen::Vector3d& origin_V, const ToolField& tool,
                 const Pose& X_VT) noexcept override;
    EnergyTerm at(const Pose& X_VT) const noexcept override;

    EffectList effects_;
    uint32_t needs_ = 0;
    double stiffness_per_area_;
    double burr_slack_ = 0;  // m
    EffectTick tick_;
    std::vector<SurfaceContact> contacts_;  // room for all candidates, if any effect reads them
    std::vector<uint8_t> is_on_burr_;
    std::vector<double> rubbing_radius_;
    std::vector<float> place_area_;
};

// This makes the effects of what a scene lists. It is for start-up only, since it allocates.
struct EffectRoom {
    double dt;                   // s
    double largest_burr_radius;  // m, of all tools
    double largest_burr_reach;   // m, of all tools: Burr::reach()
    size_t most_contacts;
    size_t most_cells;   // as MillingConfig
    double longest_way;  // m, of a burr between the ticks that mill
};

// An effect may need this beside its own config.
struct EffectNeeds {
    const EffectConfigs& all;
    const BoneModel& bone;
    const EffectRoom& room;
};

// The effects stand in the order in which they act.
inline EffectList makeEffects(const EffectConfigs& configs, const BoneModel& bone, const EffectRoom& room) {
    EffectList effects;
    forEachEffect(configs, [&](const auto& config) {
        if (config) effects.push_back(config->make({configs, bone, room}));
    });
    return effects;
}

}  // namespace bonemill
