// The settings under test. The only place that knows how a variant is built and where its figures stand.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/tick/haptic_tick.h"

namespace bonemill::test {

struct Variant {
    std::string name;
    Preset preset;

    bool isBaseline() const { return preset == Preset::kThesis2012; }
};

const std::vector<Variant>& allVariants();
const Variant& baselineVariant();

void applyVariant(const Variant& variant, TickConfig& config);

// What the coupling in force is like, whichever model the settings choose. N/m, N·m/rad (small angles), m/s,
// rad/s.
struct CouplingFigures {
    double translation_stiffness, quick_stiffness;  // N/m: held, and for what changes from tick to tick
    double rotation_stiffness, max_speed, max_angular_speed;
};
CouplingFigures couplingFigures(const TickConfig& config);

// Of the model in force: k_t; N/m per point (thesis) or N/m³ (gradient).
double& couplingStiffness(TickConfig& config);
double& contactStiffness(TickConfig& config);

// Makes free air feel like this (N·s/m) at the coupling's stiffness: gradient by its damping time,
// thesis_2012 by its static damping, which as printed is 0.5 whatever the stiffness.
void setDragInAir(TickConfig& config, double drag);

}  // namespace bonemill::test
