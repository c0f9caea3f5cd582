// The gradient law is told this at the start, apart from the model that works with it.
#pragma once

#include <cstddef>

#include "common/base/units.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/coupling/energy_coupling.h"

namespace bonemill {

struct GradientConfig {
    GradientContactConfig contact;
    EnergyCouplingConfig coupling;
    double max_speed = 0.5;                    // m/s of the tool point
    double max_angular_speed = 240 * kDegree;  // rad/s
    // About this many points may be tested in a tick; a test is one point's distance, energy and wrench at
    // one pose. A quarter as many candidates have room.
    size_t most_point_tests = 2'000'000;
};

}  // namespace bonemill
