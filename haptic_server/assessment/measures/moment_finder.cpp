#include "haptic_server/assessment/measures/moment_finder.h"

#include <cstdio>

#include "common/base/units.h"

namespace bonemill {
namespace {

// How bad a moment is next to those of other kinds; 1 is a limit reached.
constexpr double kDamageSeverity = 10, kTouchSeverity = 3, kHeatSeverity = 2;

std::string rounded(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

}  // namespace

void MomentFinder::extend(Spell& spell, double t_s, double value) noexcept {
    if (!spell.is_on) spell = {true, t_s, t_s, t_s, value, 0};
    spell.last_s = t_s;
    if (value <= spell.worst) return;
    spell.worst = value;
    spell.worst_s = t_s;
}

void MomentFinder::add(const TickStep& step) {
    addForce(step);
    if (scene_.recorded.heat) addHeat(step);
    if (!structures_.empty()) addStructures(step);
}

void MomentFinder::addForce(const TickStep& step) {
    if (force_.is_on && step.t() - force_.last_s > kPause) endForce();
    if (step.isInContact()) extend(force_, step.t(), step.force());
}

void MomentFinder::endForce() {
    force_.is_on = false;
    moments_.add(
        {force_.worst_s, "force", rounded(force_.worst) + " N on the bone", force_.worst / force_limit_});
}

void MomentFinder::addHeat(const TickStep& step) {
    if (heat_.is_on && step.t() - heat_.last_s > kPause) endHeat();
    if (step.record.effects.events & kEventTooHot)
        extend(heat_, step.t(), double(step.record.effects.temperature));
}

void MomentFinder::endHeat() {
    heat_.is_on = false;
    char text[64];
    std::snprintf(text, sizeof text, "bone at %.0f °C", heat_.worst);
    moments_.add({heat_.begin_s, "heat", text, kHeatSeverity});
}

void MomentFinder::addStructures(const TickStep& step) {
    const EffectRecord& effects = step.record.effects;
    for (size_t id = 0; id < structures_.size(); ++id) {
        Structure& structure = structures_[id];
        if (structure.touch.is_on && step.t() - structure.touch.last_s > kPause) endTouch(id);
        if (structure.damage.is_on && step.t() - structure.damage.last_s > kPause) endDamage(id);
    }
    const double damaged = std::max(0.0, double(effects.damaged_volume) - damaged_);
    damaged_ = effects.damaged_volume;
    const auto isKnown = [this](uint32_t id) { return id >= 1 && id <= structures_.size(); };
    if ((effects.events & kEventProtectedTouched) && isKnown(effects.touched_id))
        extend(structures_[effects.touched_id - 1].touch, step.t(), double(effects.protected_force));
    if (!(effects.events & kEventProtectedDamaged) || !isKnown(effects.damaged_id)) return;
    Structure& hit = structures_[effects.damaged_id - 1];
    const bool is_new = !hit.damage.is_on;
    extend(hit.damage, step.t(), 0);
    if (is_new) hit.damage.before = hit.damaged;
    hit.damaged += damaged;
}

// A structure that is cut was touched.
void MomentFinder::endTouch(size_t id) {
    Structure& structure = structures_[id];
    structure.touch.is_on = false;
    if (structure.damage.is_on || structure.damage.last_s > structure.touch.begin_s) return;
    moments_.add({structure.touch.begin_s, "touch",
                  scene_.materials[id] + " touched with " + rounded(structure.touch.worst) + " N",
                  kTouchSeverity + structure.touch.worst / force_limit_});
}

void MomentFinder::endDamage(size_t id) {
    Structure& structure = structures_[id];
    structure.damage.is_on = false;
    const double mm3 = (structure.damaged - structure.damage.before) * kPerCubicMillimetre;
    moments_.add({structure.damage.begin_s, "damage", scene_.materials[id] + " cut: " + rounded(mm3) + " mm³",
                  kDamageSeverity + mm3});
}

void MomentFinder::finish() {
    if (force_.is_on) endForce();
    if (heat_.is_on) endHeat();
    for (size_t id = 0; id < structures_.size(); ++id) {
        if (structures_[id].touch.is_on) endTouch(id);
        if (structures_[id].damage.is_on) endDamage(id);
    }
}

}  // namespace bonemill
