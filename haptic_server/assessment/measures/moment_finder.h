// Finds the moments of an attempt that are worth another look: damage and touch of structures, heat, and the
// hardest press of each contact. SI. One normal thread; memory is bounded.
#pragma once

#include <algorithm>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/tick_step.h"

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
    static constexpr double kHardForce = 10;  // N: counts as the limit where the scene has none
    static constexpr double kPause = 0.5;     // s: what goes on after less is the same moment

    explicit MomentFinder(const TechniqueScene& scene)
        : scene_(scene),
          force_limit_(scene.force_limit > 0 ? scene.force_limit : kHardForce),
          structures_(scene.recorded.protection ? scene.materials.size() : 0) {}

    void add(const TickStep& step);
    // Ends what is under way.
    void finish();
    std::vector<Moment> inOrder() const { return moments_.inOrder(); }

  private:
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
    void addForce(const TickStep& step);
    void addHeat(const TickStep& step);
    void addStructures(const TickStep& step);
    void endForce();
    void endHeat();
    void endTouch(size_t id);
    void endDamage(size_t id);
    static void extend(Spell& spell, double t_s, double value) noexcept;

    TechniqueScene scene_;
    double force_limit_;
    Spell force_, heat_;
    std::vector<Structure> structures_;
    double damaged_ = 0;  // m³ of all structures
    WorstMoments moments_;
};

}  // namespace bonemill
