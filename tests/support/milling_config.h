// Gives the settings of a tick that mills and adds by time, as most tests of the tick want it.
#pragma once

#include "haptic_server/tick/tick_config.h"

namespace bonemill::test {

inline FixedTickConfig millingConfig() {
    FixedTickConfig config;
    config.effects.time_removal.emplace();
    config.effects.add_material.emplace();
    return config;
}

}  // namespace bonemill::test
