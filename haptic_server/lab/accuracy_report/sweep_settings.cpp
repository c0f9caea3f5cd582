#include "haptic_server/lab/accuracy_report/sweep_settings.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/scene/setup/scene_accuracy.h"

namespace bonemill {
namespace {

class Choices {
  public:
    void add(const AccuracySettings& settings) {
        if (std::find(list.begin(), list.end(), settings) == list.end()) list.push_back(settings);
    }
    // Makes `base` with one member changed.
    template <class Value>
    void vary(AccuracySettings base, Value AccuracySettings::*knob, std::initializer_list<Value> values) {
        for (const Value value : values) {
            base.*knob = value;
            add(base);
        }
    }

    std::vector<AccuracySettings> list;
};

void addAroundBalanced(Choices& choices, bool has_shapes) {
    using S = AccuracySettings;
    S base = presetSettings(Preset::kBalanced);
    S grid = base;
    grid.tool_distance = ToolDistance::kGrid;
    if (!has_shapes) base = grid;
    choices.vary(base, &S::shell_factor, {2, 3});
    S plain = base, dense = base;
    plain.sample_spacing = 0, plain.most_samples = 0;
    dense.sample_spacing = presetSettings(Preset::kExact).sample_spacing;
    dense.most_samples = presetSettings(Preset::kExact).most_samples;
    choices.add(plain);
    choices.add(dense);
    choices.vary(grid, &S::sdf_refinement, {1, 2, 4});
    choices.vary(base, &S::precision, {Precision::kDouble});
    choices.vary(base, &S::iterations, {1, 2, 8});
    choices.vary(base, &S::continuous_collision, {false});
    dense.iterations = 8;
    choices.add(dense);
}

// Goes down to the least that there is.
void addCheap(Choices& choices, bool has_shapes) {
    AccuracySettings cheap;
    cheap.tool_distance = has_shapes ? ToolDistance::kAnalytic : ToolDistance::kGrid;
    cheap.sample_spacing = 0, cheap.most_samples = 0;
    cheap.iterations = 1;
    choices.vary(cheap, &AccuracySettings::shell_factor, {1, 2, 3});
    cheap.tool_distance = ToolDistance::kGrid;
    cheap.shell_factor = 3;
    choices.add(cheap);
}

void setTo(scene::Accuracy& knobs, const AccuracySettings& settings) {
    using scene::Accuracy;
    knobs.set_contact_law(scene::Accuracy::ContactLaw(settings.law));
    knobs.set_shell_factor(uint32_t(settings.shell_factor));
    knobs.set_sample_spacing_um(std::round(kPerMicrometre * settings.sample_spacing * 1e3) / 1e3);
    knobs.set_most_samples(uint32_t(settings.most_samples));
    knobs.set_tool_distance(settings.tool_distance == ToolDistance::kGrid ? Accuracy::GRID
                                                                          : Accuracy::ANALYTIC);
    knobs.set_sdf_refinement(uint32_t(settings.sdf_refinement));
    knobs.set_precision(settings.precision == Precision::kDouble ? Accuracy::DOUBLE : Accuracy::FLOAT);
    knobs.set_iterations(uint32_t(settings.iterations));
    knobs.set_continuous_collision(settings.continuous_collision);
}

}  // namespace

std::vector<AccuracySettings> sweepSettings(const AccuracySettings& of_scene, bool has_shapes) {
    Choices choices;
    for (const Preset preset : allPresets()) choices.add(presetSettings(preset));
    addAroundBalanced(choices, has_shapes);
    addCheap(choices, has_shapes);
    choices.vary(presetSettings(Preset::kThesis2012), &AccuracySettings::shell_factor, {1, 2});
    choices.add(of_scene);
    return choices.list;
}

scene::Scene sceneWith(const scene::Scene& scene, const AccuracySettings& settings) {
    scene::Scene changed = scene;
    setTo(*changed.mutable_accuracy(), settings);
    return changed;
}

}  // namespace bonemill
