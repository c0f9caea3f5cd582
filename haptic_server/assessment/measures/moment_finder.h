// Finds the moments of an attempt that are worth another look: damage and touch of structures, heat, and the
// hardest press of each contact. SI. One normal thread; memory is bounded.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/motion.h"

namespace bonemill {

// Keeps the worst moments of an attempt, as many as a time-line can show.
class WorstMoments {
  public:
    static constexpr size_t kMaxKept = 64;

    // When there are too many, the mildest goes.
    void add(Moment moment) {
        kept_.push_back(std::move(moment));
        if (kept_.size() <= kMaxKept) return;
        kept_.erase(std::ranges::min_element(kept_, {}, &Moment::severity));
    }
    std::vector<Moment> inOrder() const {
        std::vector<Moment> moments = kept_;
        std::ranges::stable_sort(moments, {}, &Moment::t_s);
        return moments;
    }

  private:
    std::vector<Moment> kept_;
};

// The `count` worst of them, the worst one first.
inline std::vector<Moment> worstOf(std::vector<Moment> moments, size_t count) {
    std::ranges::stable_sort(moments, std::ranges::greater{}, &Moment::severity);
    if (moments.size() > count) moments.resize(count);
    return moments;
}

class MomentFinder {
  public:
    static constexpr double kHardForce = 10;    // N: counts as the limit where the scene has none
    static constexpr double kLeastForce = 0.2;  // N: who presses less has not pressed
    static constexpr double kPause = 0.5;       // s: what goes on after less is the same moment

    explicit MomentFinder(const TechniqueScene& scene)
        : scene_(scene),
          force_limit_(scene.force_limit > 0 ? scene.force_limit : kHardForce),
          structures_(scene.recorded.protection ? scene.materials.size() : 0) {}

    void add(const TickStep& step) {
        addForce(step);
        if (scene_.recorded.heat) addHeat(step);
        if (!structures_.empty()) addStructures(step);
    }
    // Ends what is under way.
    void finish() {
        if (force_.is_on) endForce();
        if (heat_.is_on) endHeat();
        for (size_t id = 0; id < structures_.size(); ++id) {
            if (structures_[id].touch.is_on) endTouch(id);
            if (structures_[id].damage.is_on) endDamage(id);
        }
    }
    std::vector<Moment> inOrder() const { return moments_.inOrder(); }

  private:
    // How bad a moment is next to those of other kinds; 1 is a limit reached.
    static constexpr double kDamageSeverity = 10, kTouchSeverity = 3, kHeatSeverity = 2;

    static std::string rounded(double value) {
        char text[32];
        std::snprintf(text, sizeof text, "%.2g", value);
        return text;
    }
    // Something that lasts: from its first to its last tick.
    struct Spell {
        bool is_on = false;
        double begin_s = 0, last_s = 0, worst_s = 0;
        double worst = 0;   // N or °C
        double before = 0;  // m³
    };
    struct Structure {
        Spell touch, damage;
        double damaged = 0;  // m³ in all
    };
    // With what the burr lies on as the attempt begins the trainee has done nothing yet.
    void addForce(const TickStep& step) {
        if (force_.is_on && step.t() - force_.last_s > kPause) endForce();
        if (!step.isInContact() || step.record.removed > 0) has_begun_ = true;
        if (step.isInContact() && has_begun_) extend(force_, step.t(), step.force());
    }
    void addHeat(const TickStep& step) {
        if (heat_.is_on && step.t() - heat_.last_s > kPause) endHeat();
        if (step.record.effects.events & kEventTooHot)
            extend(heat_, step.t(), double(step.record.effects.temperature));
    }
    void addStructures(const TickStep& step) {
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
    void endForce() {
        force_.is_on = false;
        if (force_.worst < kLeastForce) return;
        moments_.add(
            {force_.worst_s, "force", rounded(force_.worst) + " N on the bone", force_.worst / force_limit_});
    }
    void endHeat() {
        heat_.is_on = false;
        char text[64];
        std::snprintf(text, sizeof text, "bone at %.0f °C", heat_.worst);
        moments_.add({heat_.begin_s, "heat", text, kHeatSeverity});
    }
    // A structure that is cut was touched.
    void endTouch(size_t id) {
        Structure& structure = structures_[id];
        structure.touch.is_on = false;
        if (structure.damage.is_on || structure.damage.last_s > structure.touch.begin_s) return;
        moments_.add({structure.touch.begin_s, "touch",
                      scene_.materials[id] + " touched with " + rounded(structure.touch.worst) + " N",
                      kTouchSeverity + structure.touch.worst / force_limit_});
    }
    void endDamage(size_t id) {
        Structure& structure = structures_[id];
        structure.damage.is_on = false;
        const double mm3 = (structure.damaged - structure.damage.before) * kPerCubicMillimetre;
        moments_.add({structure.damage.begin_s, "damage",
                      scene_.materials[id] + " cut: " + rounded(mm3) + " mm³", kDamageSeverity + mm3});
    }
    static void extend(Spell& spell, double t_s, double value) noexcept {
        if (!spell.is_on) spell = {true, t_s, t_s, t_s, value, 0};
        spell.last_s = t_s;
        if (value <= spell.worst) return;
        spell.worst = value;
        spell.worst_s = t_s;
    }

    TechniqueScene scene_;
    double force_limit_;
    Spell force_, heat_;
    bool has_begun_ = false;
    std::vector<Structure> structures_;
    double damaged_ = 0;  // m³ of all structures
    WorstMoments moments_;
};

}  // namespace bonemill
