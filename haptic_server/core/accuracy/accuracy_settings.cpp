#include "haptic_server/core/accuracy/accuracy_settings.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bonemill {
namespace {
// A law that is a preset of its own is called as that.
constexpr std::string_view kNames[] = {"thesis_2012", "fast", "balanced",    "exact",
                                       "proxy_3dof",  "vps",  "penalty_sdf", "constraint"};
static_assert(std::size(kNames) == kPresetCount);
constexpr std::string_view kLawNames[] = {
    kNames[size_t(Preset::kThesis2012)], "gradient",
    kNames[size_t(Preset::kProxy3Dof)],  kNames[size_t(Preset::kVps)],
    kNames[size_t(Preset::kPenaltySdf)], kNames[size_t(Preset::kConstraint)]};
static_assert(std::size(kLawNames) == kLawCount);

// One point per cell with exact distances; what else the law knows is `iterations`.
AccuracySettings comparedLaw(ContactLaw law, int iterations) noexcept {
    return {.law = law,
            .sample_spacing = 0,
            .most_samples = 0,
            .sdf_refinement = 1,
            .iterations = iterations,
            .continuous_collision = iterations > 1};
}
}  // namespace

std::string_view lawName(ContactLaw law) noexcept {
    return kLawNames[size_t(law)];
}

AccuracySettings presetSettings(Preset preset) noexcept {
    switch (preset) {
        case Preset::kThesis2012:  // scaling factor 3 as in its demonstrations
            return {.law = ContactLaw::kThesis2012,
                    .shell_factor = 3,
                    .sample_spacing = 0,
                    .most_samples = 0,
                    .tool_distance = ToolDistance::kGrid,
                    .sdf_refinement = 1,
                    .iterations = 1,
                    .continuous_collision = false};
        case Preset::kFast:
            return {.sample_spacing = 80 * kMicrometre,
                    .most_samples = 512,
                    .sdf_refinement = 1,
                    .iterations = 2};
        case Preset::kBalanced:
            return {};
        case Preset::kExact:
            return {.sample_spacing = 30 * kMicrometre,
                    .most_samples = 3072,
                    .sdf_refinement = 4,
                    .precision = Precision::kDouble,
                    .iterations = 12};
        case Preset::kProxy3Dof:
            return comparedLaw(ContactLaw::kProxy3Dof, 8);
        case Preset::kVps:
            return comparedLaw(ContactLaw::kVps, 1);
        case Preset::kPenaltySdf:
            return comparedLaw(ContactLaw::kPenaltySdf, 1);
        case Preset::kConstraint:
            return comparedLaw(ContactLaw::kConstraint, 8);
    }
    return {};
}

std::string_view presetName(Preset preset) noexcept {
    return kNames[size_t(preset)];
}

std::vector<Preset> allPresets() {
    std::vector<Preset> all(std::begin(kPresets), std::end(kPresets));
    all.insert(all.end(), std::begin(kComparedLaws), std::end(kComparedLaws));
    return all;
}

std::optional<Preset> presetOfName(std::string_view name) noexcept {
    const auto found = std::ranges::find(kNames, name);
    if (found == std::end(kNames)) return std::nullopt;
    return Preset(found - std::begin(kNames));
}

std::string presetNames() {
    std::string names;
    for (const Preset preset : allPresets())
        names += (names.empty() ? "" : ", ") + std::string(presetName(preset));
    return names;
}

std::string settingsName(const AccuracySettings& settings) {
    for (const Preset preset : allPresets())
        if (presetSettings(preset) == settings) return std::string(presetName(preset));
    std::string name(settings.law == ContactLaw::kThesis2012 ? "thesis" : lawName(settings.law));
    name += " s=" + std::to_string(settings.shell_factor);
    if (settings.law == ContactLaw::kThesis2012) return name;
    if (settings.sample_spacing > 0)
        name += " samples " + std::to_string(std::lround(1e6 * settings.sample_spacing)) + " um/" +
                std::to_string(settings.most_samples);
    name += settings.tool_distance == ToolDistance::kGrid
                ? " grid x" + std::to_string(settings.sdf_refinement)
                : " analytic";
    name += settings.precision == Precision::kFloat ? " float" : " double";
    name += " iterations=" + std::to_string(settings.iterations);
    return name + (settings.continuous_collision ? " ccd" : " no ccd");
}

}  // namespace bonemill
