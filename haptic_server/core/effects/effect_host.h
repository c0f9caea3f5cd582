// The tick and the contact model call the effects of a scene through this. If none is listed, nothing
// is called.
#pragma once

#include <memory>
#include <vector>

#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/equilibrium/solve_energy.h"

namespace bonemill {

class SpoModel;

using EffectList = std::vector<std::unique_ptr<HapticEffect>>;

class EffectHost final : private ContactWeights, private SolveEnergy {
  public:
    // Allocates room for the contacts of `most_candidates`; κ is in N/m³.
    EffectHost(EffectList effects, size_t most_candidates, double stiffness_per_area);

    // The contact model takes these; null means that no effect needs it. They live as long as the host.
    ContactWeights* weights() noexcept {
        return any(HapticEffect::kScales | HapticEffect::kReadsContacts) ? this : nullptr;
    }
    SolveEnergy* energy() noexcept { return any(HapticEffect::kHasEnergy) ? this : nullptr; }

    // The phases of a tick come in this order. Each is RT-safe, for the tick thread only.
    void restart(Restart why) noexcept;
    void begin(const EffectTick& start) noexcept;  // takes from it what is known at the start
    void addToHand(Wrench& wrench_V) noexcept;
    // Tells, after the force went out, where the solve ended and what its contacts are.
    void afterSolve(const Pose& X_VT, SpoModel& model) noexcept;
    void mill(BoneModel& bone, MillingResult& result) noexcept;
    const EffectRecord& finish() noexcept;

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
    std::vector<float> place_area_;
};

}  // namespace bonemill
