// Measures what happened to each protected structure: episodes of damage (a new one after 0.5 s without),
// what was cut of it, how near the burr came and how hard it pressed. SI. One normal thread; memory is
// bounded by the number of materials.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/technique_scene.h"
#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

class StructureMeter {
  public:
    static constexpr double kEpisodeGap = 0.5;  // s

    struct Structure {
        double distance = std::numeric_limits<double>::infinity();  // m, least
        double force = 0;                                           // N, largest
        size_t episodes = 0;
        double damaged = 0;      // m³
        double damage_time = 0;  // s
        double last_damage_s = -std::numeric_limits<double>::infinity();
        bool isTouched() const noexcept { return force > 0 || episodes > 0; }
    };

    explicit StructureMeter(const TechniqueScene& scene)
        : scene_(scene), structures_(scene.recorded.protection ? scene.materials.size() : 0) {}

    void add(const TickStep& step) noexcept;
    // In the scene's order of materials; empty where nothing is protected.
    const std::vector<Structure>& structures() const noexcept { return structures_; }
    void append(Figures& figures) const;

  private:
    Structure* of(uint32_t id) noexcept {
        return id >= 1 && id <= structures_.size() ? &structures_[id - 1] : nullptr;
    }

    TechniqueScene scene_;
    std::vector<Structure> structures_;
    double damaged_ = 0;  // m³, of all, so far
};

}  // namespace bonemill
