#include "haptic_server/assessment/measures/structure_meter.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "haptic_server/assessment/measures/definitions.h"

namespace bonemill {

void StructureMeter::add(const TickStep& step) noexcept {
    const EffectRecord& effects = step.record.effects;
    if (Structure* nearest = of(effects.protected_id))
        nearest->distance = std::min(nearest->distance, double(effects.protected_distance));
    Structure* const touched = of(effects.touched_id);
    if (touched && (effects.events & kEventProtectedTouched))
        touched->force = std::max(touched->force, double(effects.protected_force));
    const double damaged = std::max(0.0, double(effects.damaged_volume) - damaged_);
    damaged_ = effects.damaged_volume;
    Structure* const hit = of(effects.damaged_id);
    if (!hit || !(effects.events & kEventProtectedDamaged)) return;
    if (step.t() - hit->last_damage_s > kEpisodeGap) ++hit->episodes;
    hit->last_damage_s = step.t();
    hit->damaged += damaged;
    hit->damage_time += step.dt;
}

// A structure that was never in reach was not cut: a gate may ask for that. How far it was is unknown.
void StructureMeter::append(Figures& figures) const {
    for (size_t id = 0; id < structures_.size(); ++id) {
        const Structure& structure = structures_[id];
        const bool was_in_reach = std::isfinite(structure.distance);
        if (!scene_.isProtected(id) && !was_in_reach && !structure.isTouched()) continue;
        const std::string& name = scene_.materials[id];
        put(figures, "damage.episodes", double(structure.episodes), name);
        put(figures, "damage.volume", structure.damaged * kPerCubicMillimetre, name);
        put(figures, "damage.time", structure.damage_time, name);
        put(figures, "structure.force", structure.force, name);
        if (was_in_reach) put(figures, "structure.distance", structure.distance * kPerMillimetre, name);
    }
}

}  // namespace bonemill
