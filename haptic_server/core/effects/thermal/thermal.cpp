// Cutting heats the bone: shares of the friction power |Ω| Σ μ F ρ of the burr's contacts, one of what cuts
// and one of what only rubs, go into the bone where they touch, spread (heat_grid.h), and leave it to
// irrigation while the pedal is down, to the dry surroundings and to the blood. The rest of the power goes
// with chips and burr.
#include <cmath>

#include "common/geometry/coolant_nozzle.h"
#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/thermal/heat_grid.h"

namespace bonemill {
namespace {

constexpr size_t kMaxSources = 64;  // in a tick; of more contacts every nth takes the heat of n, in turn

class Thermal final : public HapticEffect {
  public:
    // Keeps a reference to the bone. dt is the time of a tick, in s.
    Thermal(const ThermalConfig& config, const BoneModel& bone, double dt)
        : HapticEffect(kReadsContacts), config_(config), heat_(config.heat, bone.volume, dt) {}
    void restart(Restart why) noexcept override {
        if (why == Restart::kBonePutBack) heat_.noteChangeEverywhere();
        if (why == Restart::kScanPutBack) heat_.forget();
    }
    void mill(EffectTick&, BoneModel&, MillingResult& result) noexcept override {
        // A cube is bone or it is not: where no voxel became the other, none did.
        if (result.removed_voxels > 0 || result.added_voxels > 0) heat_.noteChange(result.changed);
    }
    void finish(EffectTick& tick) noexcept override {
        putIn(tick);
        const Eigen::Vector3d p_TN = config_.p_TN.value_or(usualNozzle(tick.tool->burr.radius));
        heat_.irrigate(tick.X_VT.position, tick.is_pedal_down ? config_.irrigation_radius : 0,
                       tick.X_VT * p_TN);
        heat_.step(tick.has_time);
        EffectRecord& record = tick.record;
        const double hottest = heat_.hottest();
        record.temperature = float(hottest);
        record.necrotic_volume = float(heat_.necroticVolume());
        if (hottest >= config_.heat.necrosis_temperature) record.events |= kEventTooHot;
    }

  private:
    // Of μ, with the share of each mechanism that goes into the bone.
    double heatPerMoment(const EffectTick& tick) const noexcept {
        const Burr& burr = tick.tool->burr;
        return tick.cut_share * config_.heat_share * burr.friction +
               (1 - tick.cut_share) * config_.rubbingShare(burr.grit) * burr.rubbing_friction;
    }
    void putIn(const EffectTick& tick) noexcept {
        const double per_moment = heatPerMoment(tick) * std::abs(tick.spin_speed);  // W per N·m
        if (per_moment == 0) return;
        size_t count = 0;
        double chosen = 0;
        const size_t every = tick.burr_load.contacts / kMaxSources + 1;
        const size_t first = turn_++ % every;
        const auto isChosen = [&](size_t n) { return n % every == first; };
        forEachBurrContact(tick, [&](const SurfaceContact& contact, const Eigen::Vector3d&, double rho) {
            if (isChosen(count++)) chosen += double(contact.force) * rho;
        });
        if (chosen == 0) return;
        const double heat_per_moment = per_moment * tick.dt * (tick.burr_load.moment / chosen);
        count = 0;
        forEachBurrContact(tick, [&](const SurfaceContact& contact, const Eigen::Vector3d& r, double rho) {
            if (!isChosen(count++)) return;
            heat_.addHeat(tick.X_VT.position + r, -contact.push_V.cast<double>(),
                          heat_per_moment * double(contact.force) * rho);
        });
    }

    ThermalConfig config_;
    HeatGrid heat_;
    size_t turn_ = 0;
};

}  // namespace

std::unique_ptr<HapticEffect> ThermalConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<Thermal>(*this, needs.bone, needs.room.dt);
}

}  // namespace bonemill
