// Gives the settings of a tick that mills and adds by time, as most tests of the tick want it.
#pragma once

#include "haptic_server/core/tick/tick_config.h"
#include "tests/support/typical_effects.h"

namespace bonemill::test {

inline FixedTickConfig millingConfig() {
    FixedTickConfig config;
    config.effects.time_removal = test::kTimeRemoval;
    config.effects.add_material = test::kAddMaterial;
    return config;
}

}  // namespace bonemill::test
