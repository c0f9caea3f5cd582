#include "haptic_server/core/effects/thermal/thermal.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/make_effects.h"

namespace bonemill {
namespace {

constexpr size_t kMaxSources = 256;  // in a tick; of more contacts every nth takes the heat of n, in turn

}  // namespace

Thermal::Thermal(const ThermalConfig& config, const BoneModel& bone, double dt)
    : HapticEffect(kReadsContacts), config_(config), heat_(config.heat, bone.volume, dt) {}

void Thermal::putIn(const EffectTick& tick) noexcept {
    const double per_moment = tick.tool->burr.friction * std::abs(tick.spin_speed);  // W per N·m
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
    const double heat_per_moment =
        config_.heat_share * per_moment * tick.dt * (tick.burr_load.moment / chosen);
    count = 0;
    forEachBurrContact(tick, [&](const SurfaceContact& contact, const Eigen::Vector3d& r, double rho) {
        if (!isChosen(count++)) return;
        heat_.addHeat(tick.X_VT.position + r, -contact.push_V.cast<double>(),
                      heat_per_moment * double(contact.force) * rho);
    });
}

void Thermal::finish(EffectTick& tick) noexcept {
    putIn(tick);
    heat_.irrigate(tick.X_VT.position, tick.is_pedal_down ? config_.irrigation_radius : 0);
    heat_.step();
    EffectRecord& record = tick.record;
    const double hottest = heat_.hottest();
    record.temperature = float(hottest);
    record.necrotic_volume = float(heat_.necroticVolume());
    if (hottest >= config_.heat.necrosis_temperature) record.events |= kEventTooHot;
}

std::unique_ptr<HapticEffect> ThermalConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<Thermal>(*this, needs.bone, needs.room.dt);
}

}  // namespace bonemill
