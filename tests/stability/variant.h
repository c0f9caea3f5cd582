// These are the settings under test. Only this place knows how a variant is built and where its
// figures stand.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/tick/hand_side.h"
#include "haptic_server/core/tick/tick_io.h"

namespace bonemill::test {

using Names = std::vector<std::string>;

struct Variant {
    std::string name;
    Preset preset;
    // Adds effects in place of milling by time; null stands for milling by time.
    void (*add_effects)(EffectConfigs&) = nullptr;
    uint32_t held_buttons = 0;  // all the while: with effects of a burr that turns the pedal is down
    const DeviceCapabilities* device = nullptr;  // null: none has told of itself
    double workspace_scale = 1;

    bool isBaseline() const { return preset == Preset::kThesis2012; }
    bool isOtherLaw() const;  // one of lawVariants()
};

const std::vector<Variant>& allVariants();
const Variant& baselineVariant();

// These are the contact laws of other schools (docs/explanation/laws.md).
const std::vector<Variant>& lawVariants();
Names everyLaw();

// They are the default preset with each haptic effect alone, with all of them that leave the bone as it is
// ("all_felt"), and with all ("all_effects").
const std::vector<Variant>& effectVariants();
Names feltEffects();                          // of the variants that leave the bone as it is
Names feltEffectsBut(const Names& left_out);  // and not all together
// The burr of these spins faster than vibration can follow, and its friction is as high as can be expected.
inline constexpr double kSpinSpeed = 4000, kCuttingFriction = 0.7;  // rad/s; μ_c
// The vibration is of 400 Hz then: over N ticks it sums to nothing.
inline constexpr size_t kVibrationTicks = 5;

// They are the default preset with other devices: an arm that gives 3 N and no torque ("arm"), and workspaces
// of which the tool's is smaller and larger than the handle's ("scale_0_3", "scale_3").
const std::vector<Variant>& deviceVariants();
extern const DeviceCapabilities kArm;
Names scaledWorkspaces();
Names everyDevice();
Names operator+(Names a, const Names& b);

void applyVariant(const Variant& variant, FixedTickConfig& config);

// It says what the coupling in force is like, whichever model the settings choose. Units are N/m, N·m/rad
// (small angles), m/s, rad/s.
struct CouplingFigures {
    double translation_stiffness, quick_stiffness;  // N/m: held, and for what changes from tick to tick
    double rotation_stiffness, max_speed, max_angular_speed;
};
CouplingFigures couplingFigures(const FixedTickConfig& config);

// These are of the model in force: k_t, and N/m per point (thesis, vps, penalty_sdf) or N/m³ (gradient; rigid
// laws have none, and do not look at it).
double& couplingStiffness(FixedTickConfig& config);
double& contactStiffness(FixedTickConfig& config);

// Makes free air feel like this (N·s/m) at the coupling's stiffness: the gradient presets by their damping
// time, thesis_2012 by its static damping, which as printed is 0.5 whatever the stiffness, and so does vps
// and penalty_sdf. The rigid laws have no drag in air.
void setDragInAir(FixedTickConfig& config, double drag);

}  // namespace bonemill::test
