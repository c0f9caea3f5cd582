// The settings under test. The only place that knows how a variant is built.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/tick/haptic_tick.h"

namespace bonemill::test {

struct Variant {
    std::string name;
    int shell_scaling_factor = 1;         // PointShell
    void (*edit)(TickConfig&) = nullptr;  // null: TickConfig's defaults
    // What "contact stiffness" means: N/m per point in the thesis' model, N/m³ in the gradient model.
    void (*set_contact_stiffness)(TickConfig&, double) = nullptr;
    double contact_stiffness = 0;  // its default
};

const std::vector<Variant>& allVariants();
const Variant& baselineVariant();

}  // namespace bonemill::test
