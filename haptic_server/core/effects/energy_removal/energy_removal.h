// Removes by pressure times cutting speed against the bone's specific energy (ALGORITHMS §4).
//
// Per area of the contact between burr and bone, with pressure p, friction μ_c and cutting speed v_c, the
// power μ_c (p - p_th)₊ v_c goes into bone of specific energy u, whose surface recedes at v_n = μ_c v_c (p -
// p_th)₊ / u (Archard's law of wear, its rate given by energy).
//
// The time constant of that wear against the contact's stiffness κ (N/m³), u/(μ_c κ v_c), is shorter than a
// tick. The tick therefore takes it implicitly (backward Euler). With c = μ_c v_c / u and the recession s =
// dt c p in this tick, p = κ (δ - s) makes p = κ δ / (1 + κ c dt): scale() multiplies each point's weight by
// 1/(1 + κ c dt), so that the solve moves the tool through what the tick will cut. At a steady feed v the
// pressure is v/c whatever dt and κ. The threshold is not in the weights: below it the burr only rubs, on
// bone as soft as that, and sinks in by dt c p_th more. (A weight by the depth of the tick before swings: its
// gain is κ c dt p_th/p.)
//
// v_c = |Ω| ρ with the mean of ρ over the point's patch (burr_speed.h), so that the pole of a burr cuts,
// if hardly.
//
// Bone under a large burr takes turns: with more contacts than a tick has time for, the leaves mill in
// `turns` groups with about as many patches each (leaf_turns.h), each in every turns-th tick and for as many
// ticks at once (the weights, too, then know that dt).
//
// The cut surface is the burr's only within some micrometres, which is as much as the contact is deep: on
// coarse voxels, and with a stiff contact (a short tick), few places carry what many should, at pressures far
// above the mean. So the pressure that counts against the threshold is the mean over a region of the burr,
// its force over the whole area of the patches that touch, and each contact gives its power times the share
// of that mean which is above.
//
// mill() then spends the energy of the contacts on the surface (milling/surface_shift.h). What was spent too
// much or too little is kept in an account and made good within kRepayTime, so that Σ u ΔV = ∫ P dt but for
// what is in the account.
#pragma once

#include <array>
#include <climits>

#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/energy_removal/leaf_turns.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/milling/surface_shift.h"

namespace bonemill {

struct EffectRoom;

class EnergyRemoval final : public HapticEffect {
  public:
    static constexpr double kRepayTime = 5e-3;       // s
    static constexpr double kMaxShare = 2;           // of a tick's energy, that it may spend
    static constexpr size_t kMaxTurnsAtOnce = 3;     // or periods, that a surface may make good in a tick
    static constexpr size_t kCellsPerContact = 250;  // one takes as long as so many milled cells

    // The bone's properties and materials are taken from `all`.
    EnergyRemoval(const EnergyRemovalConfig& config, const EffectConfigs& all, const BoneModel& bone,
                  const EffectRoom& room);
    void restart(Restart) noexcept override {
        account_ = to_repay_ = 0, turn_ = 0, turns_ = 1, leaf_turns_.clear();
    }
    void begin(EffectTick& tick) noexcept override;
    double scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                 const ToolField& tool, const Pose& X_VT) noexcept override;
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override;
    void finish(EffectTick& tick) noexcept override;

  private:
    double energyFactor(const Burr& burr) const noexcept {
        return burr.grit == BurrGrit::kDiamond ? config_.diamond_energy_factor : 1;
    }
    double softness(const EffectTick& tick, const Candidates& candidates, size_t n,
                    const Eigen::Vector3d& origin_V, const Eigen::Vector3d& p_T) noexcept;
    struct Region {
        double force = 0, area = 0;  // N, m²: of its patches that touch
    };
    static constexpr int kRegionsPerAxis = 4;
    static size_t regionOf(const EffectTick& tick, const SurfaceContact& contact) noexcept;
    void weighRegions(const EffectTick& tick) noexcept;
    double shareAboveThreshold(const EffectTick& tick, const SurfaceContact& contact) const noexcept;
    double specificEnergyAt(const Eigen::Vector3d& p_V) noexcept;
    double spendContacts(const EffectTick& tick, const BoneModel& bone) noexcept;
    void takeTurn(const EffectTick& tick) noexcept;
    void shareLeaves(const EffectTick& tick) noexcept;

    EnergyRemovalConfig config_;
    SpecificEnergy specific_energy_;
    Eigen::Array3d inverse_spacing_;
    Eigen::Vector3i last_cell_ = Eigen::Vector3i::Constant(INT_MIN);  // and what it takes, J/m³
    double last_energy_ = 0;
    std::array<Region, size_t(kRegionsPerAxis* kRegionsPerAxis* kRegionsPerAxis)> regions_{};
    SurfaceShift shift_;
    size_t most_contacts_;
    size_t turn_ = 0, turns_ = 1;
    LeafTurns leaf_turns_;
    bool is_cutting_ = false;
    double account_ = 0;   // J not yet spent; negative: too much was
    double to_repay_ = 0;  // J: the account when the turns began
    // These are of this tick.
    double removal_power_ = 0, removed_energy_ = 0;
};

}  // namespace bonemill
