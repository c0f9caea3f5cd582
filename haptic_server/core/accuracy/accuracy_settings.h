// The accuracy dial says what the haptic loop computes, and how finely. docs/explanation/accuracy.md says
// what each knob buys and costs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/units.h"

namespace bonemill {

// Those behind kGradient are of other schools, to compare with (docs/explanation/laws.md). The
// numbers are those of scene.proto (scene_accuracy.cpp).
enum class ContactLaw : uint8_t { kThesis2012, kGradient, kProxy3Dof, kVps, kPenaltySdf, kConstraint };
inline constexpr size_t kLawCount = 6;
// The tool's distances come from here: trilinear in its grid, or exact from its shapes (a mesh has only
// the grid).
enum class ToolDistance : uint8_t { kGrid, kAnalytic };
enum class Precision : uint8_t { kFloat, kDouble };

enum class Preset : uint8_t {
    kThesis2012,
    kFast,
    kBalanced,
    kExact,
    kProxy3Dof,
    kVps,
    kPenaltySdf,
    kConstraint
};
// The dial: the thesis and the gradient law's levels.
inline constexpr Preset kPresets[] = {Preset::kThesis2012, Preset::kFast, Preset::kBalanced, Preset::kExact};
// Each is one law of another school.
inline constexpr Preset kComparedLaws[] = {Preset::kProxy3Dof, Preset::kVps, Preset::kPenaltySdf,
                                           Preset::kConstraint};
inline constexpr size_t kPresetCount = 8;
// Returns all of them, the dial's first.
std::vector<Preset> allPresets();

// The settings are trivially copyable and may be changed between two ticks. The defaults are preset balanced.
struct AccuracySettings {
    ContactLaw law = ContactLaw::kGradient;
    int shell_factor = 1;  // s: one contact point per s×s×s cells
    double sample_spacing =
        60 * kMicrometre;    // m: near the tool the bone is sampled this finely; 0: one sample per point
    int most_samples = 768;  // as long as there are no more than about this many; else spacing gives way
    ToolDistance tool_distance = ToolDistance::kAnalytic;
    int sdf_refinement = 2;  // the scene's distance grid with nodes this many times as dense
    Precision precision = Precision::kFloat;
    int iterations = 6;                // of the equilibrium solve, 1 .. kMaxIterations; thesis_2012 has one
    bool continuous_collision = true;  // long steps are swept; without, they are cut to the trust radius

    static constexpr int kMaxIterations = 16;
    bool operator==(const AccuracySettings&) const = default;
};

AccuracySettings presetSettings(Preset preset) noexcept;

std::string_view lawName(ContactLaw law) noexcept;
std::string_view presetName(Preset preset) noexcept;
std::optional<Preset> presetOfName(std::string_view name) noexcept;
// Returns all names with commas between, for messages. It allocates.
std::string presetNames();

// Returns the preset's name, or for settings that no preset has, every knob: "gradient s=2 grid×1 float 2
// iterations ccd". It allocates.
std::string settingsName(const AccuracySettings& settings);

}  // namespace bonemill
