// What a tick is told at the start.
#pragma once

#include "haptic_server/accuracy/accuracy_settings.h"
#include "haptic_server/contact/contact_configs.h"
#include "haptic_server/coupling/virtual_coupling.h"
#include "haptic_server/effects/effect_configs.h"
#include "haptic_server/milling/timed_milling.h"
#include "haptic_server/spo/gradient_config.h"
#include "haptic_server/tool/burr.h"

namespace bonemill {

struct TickConfig {
    double dt = 1e-3;  // s
    AccuracySettings accuracy;
    PenaltyContactConfig contact;  // thesis_2012
    CouplingConfig coupling;       // thesis_2012, and the limits of what the hand may feel
    GradientConfig gradient;
    Burr burr;
    EffectConfigs effects;
    size_t most_milled_cells = MillingConfig{}.most_cells;  // in a tick
};

}  // namespace bonemill
