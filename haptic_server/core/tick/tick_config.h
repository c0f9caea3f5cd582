// A tick is told this at the start.
#pragma once

#include "common/geometry/hand_space.h"
#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/coupling/thesis_2012_coupling.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/equilibrium/spo_models.h"
#include "haptic_server/core/milling/timed_milling.h"
#include "haptic_server/core/tick/hand_limits.h"

namespace bonemill {

struct TickConfig {
    double dt = 1e-3;                          // s
    std::span<const SpoLaw> laws = ownLaws();  // that may be chosen; it outlives the making of the tick
    PenaltyContactConfig contact;              // thesis_2012
    CouplingConfig coupling;                   // thesis_2012
    HandLimitsConfig hand;
    GradientConfig gradient;
    EffectConfigs effects;
    HandSpace hand_space;                                   // `hand` is at the hand, all else at the tool
    size_t most_milled_cells = MillingConfig{}.most_cells;  // in a tick
};

// A tick whose tool and accuracy stay the same for a whole run, as in reports, benchmarks and most tests.
struct FixedTickConfig : TickConfig {
    SpoTool tool;
    AccuracySettings accuracy;

    // Returns what couples that tool in the gradient law.
    EnergyCoupling toolCoupling() const noexcept { return {gradient.coupling, tool.saturation_force}; }
};

}  // namespace bonemill
