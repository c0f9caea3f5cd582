#include "haptic_server/accuracy/accuracy_settings.h"

#include <cmath>
#include <iterator>

namespace bonemill {
namespace {
constexpr std::string_view kNames[] = {"thesis_2012", "fast", "balanced", "exact"};
}  // namespace

AccuracySettings presetSettings(Preset preset) noexcept {
    switch (preset) {
        case Preset::kThesis2012:  // scaling factor 3 as in its demonstrations
            return {ContactLaw::kThesis2012, 3, 0, 0, ToolDistance::kGrid, 1, Precision::kFloat, 1, false};
        case Preset::kFast:
            return {ContactLaw::kGradient, 1, 80e-6, 512, ToolDistance::kAnalytic, 1, Precision::kFloat, 1,
                    true};
        case Preset::kBalanced:
            return {ContactLaw::kGradient, 1, 60e-6, 768, ToolDistance::kAnalytic, 2, Precision::kFloat, 4,
                    true};
        case Preset::kExact:
            return {ContactLaw::kGradient, 1, 30e-6, 4608, ToolDistance::kAnalytic, 4, Precision::kDouble, 8,
                    true};
    }
    return {};
}

std::string_view presetName(Preset preset) noexcept {
    return kNames[size_t(preset)];
}

std::optional<Preset> presetOfName(std::string_view name) noexcept {
    for (const Preset preset : kPresets)
        if (presetName(preset) == name) return preset;
    return std::nullopt;
}

std::string presetNames() {
    std::string names;
    for (const Preset preset : kPresets)
        names += (names.empty() ? "" : ", ") + std::string(presetName(preset));
    return names;
}

std::string settingsName(const AccuracySettings& settings) {
    for (const Preset preset : kPresets)
        if (presetSettings(preset) == settings) return std::string(presetName(preset));
    std::string name = settings.law == ContactLaw::kThesis2012 ? "thesis" : "gradient";
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
