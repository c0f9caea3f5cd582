#include "haptic_server/assessment/structure_meter.h"

#include <algorithm>
#include <cmath>

#include "common/units.h"
#include "haptic_server/assessment/definitions.h"

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

// Of a structure that was never in reach there is nothing to say but that it was not cut.
void StructureMeter::append(Figures& figures) const {
    for (size_t id = 0; id < structures_.size(); ++id) {
        const Structure& structure = structures_[id];
        if (!std::isfinite(structure.distance) && !structure.isTouched()) continue;
        const std::string& name = scene_.materials[id];
        put(figures, "damage.episodes", double(structure.episodes), name);
        put(figures, "damage.volume", structure.damaged * kPerCubicMillimetre, name);
        put(figures, "damage.time", structure.damage_time, name);
        put(figures, "structure.force", structure.force, name);
        put(figures, "structure.distance", structure.distance * kPerMillimetre, name);
    }
}

}  // namespace bonemill
