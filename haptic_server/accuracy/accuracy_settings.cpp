#include "haptic_server/accuracy/accuracy_settings.h"

#include <cmath>
#include <iterator>

#include "common/units.h"

namespace bonemill {
namespace {
constexpr std::string_view kNames[] = {"thesis_2012", "fast", "balanced",    "exact",
                                       "proxy_3dof",  "vps",  "penalty_sdf", "constraint"};
static_assert(std::size(kNames) == kPresetCount);

// One point per cell with exact distances; what else the law knows is `iterations`.
AccuracySettings comparedLaw(ContactLaw law, int iterations) noexcept {
    return {law, 1, 0, 0, ToolDistance::kAnalytic, 1, Precision::kFloat, iterations, iterations > 1};
}
}  // namespace

std::string_view lawName(ContactLaw law) noexcept {
    switch (law) {
        case ContactLaw::kThesis2012:
            return "thesis_2012";
        case ContactLaw::kGradient:
            return "gradient";
        case ContactLaw::kProxy3Dof:
            return "proxy_3dof";
        case ContactLaw::kVps:
            return "vps";
        case ContactLaw::kPenaltySdf:
            return "penalty_sdf";
        case ContactLaw::kConstraint:
            return "constraint";
    }
    return "";
}

AccuracySettings presetSettings(Preset preset) noexcept {
    switch (preset) {
        case Preset::kThesis2012:  // scaling factor 3 as in its demonstrations
            return {ContactLaw::kThesis2012, 3, 0, 0, ToolDistance::kGrid, 1, Precision::kFloat, 1, false};
        case Preset::kFast:
            return {ContactLaw::kGradient,
                    1,
                    80 * kMicrometre,
                    512,
                    ToolDistance::kAnalytic,
                    1,
                    Precision::kFloat,
                    2,
                    true};
        case Preset::kBalanced:
            return {ContactLaw::kGradient,
                    1,
                    60 * kMicrometre,
                    768,
                    ToolDistance::kAnalytic,
                    2,
                    Precision::kFloat,
                    6,
                    true};
        case Preset::kExact:
            return {ContactLaw::kGradient,
                    1,
                    30 * kMicrometre,
                    4608,
                    ToolDistance::kAnalytic,
                    4,
                    Precision::kDouble,
                    12,
                    true};
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
    for (const Preset preset : kPresets)
        if (presetName(preset) == name) return preset;
    for (const Preset preset : kComparedLaws)
        if (presetName(preset) == name) return preset;
    return std::nullopt;
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
