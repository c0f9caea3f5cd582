// Measures how hot the bone got. CEM43 is the dose that tissue research counts with: minutes at 43 °C that do
// as much harm; here of the hottest bone of each instant, wherever it is, hence no less than that of any one
// place. One normal thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "haptic_server/assessment/measures/definitions.h"
#include "haptic_server/assessment/measures/technique_scene.h"
#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

class HeatMeter {
  public:
    explicit HeatMeter(const TechniqueScene& scene) : is_recorded_(scene.recorded.heat) {}

    void add(const TickStep& step) noexcept {
        if (!is_recorded_) return;
        const double temperature = step.record.effects.temperature;  // °C
        peak_ = std::max(peak_, temperature);
        necrotic_ = step.record.effects.necrotic_volume;
        if (temperature > kHot) hot_ += step.dt;
        if (temperature > kDose) dose_ += step.dt / kMinute * std::exp2(temperature - kDose);
    }
    void append(Figures& figures) const {
        if (!is_recorded_) return;
        put(figures, "heat.peak", peak_);
        put(figures, "heat.above_47", hot_);
        put(figures, "heat.cem43", dose_);
        put(figures, "heat.necrotic", necrotic_ * kPerCubicMillimetre);
    }

  private:
    static constexpr double kHot = 47, kDose = 43;  // °C; above the latter each degree doubles the dose

    bool is_recorded_;
    double peak_ = -std::numeric_limits<double>::infinity();  // °C
    double hot_ = 0, dose_ = 0;                               // s, min
    double necrotic_ = 0;                                     // m³
};

}  // namespace bonemill
