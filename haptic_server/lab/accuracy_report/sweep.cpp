#include "haptic_server/lab/accuracy_report/sweep.h"

#include <strings.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/user_error.h"
#include "haptic_server/scene/setup/scene_accuracy.h"
#include "haptic_server/scene/setup/scene_setup.h"

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
    knobs.set_contact_law(scene::Accuracy::ContactLaw(settings.law));  // as scene_accuracy.cpp asserts
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

// Settings that keep the same shell levels up to date share one bone; milling puts it back as it was.
struct SharedBone {
    BoneModel bone;
    BoneHistory history;

    SharedBone(const SweepInput& input, const ShellConfig& shell)
        : bone(VoxelVolume(input.volume), input.leaf_cells, shell), history(bone) {}
};

struct Durations {
    std::vector<int64_t> shortest, longest;  // ns, of the passes

    void add(const TimedRun& run) {
        for (const TickRecord& record : run.records) shortest.push_back(record.compute_ns);
        longest.insert(longest.end(), run.longest_ns.begin(), run.longest_ns.end());
    }
    void add(const Durations& more) {
        shortest.insert(shortest.end(), more.shortest.begin(), more.shortest.end());
        longest.insert(longest.end(), more.longest.begin(), more.longest.end());
    }
};

void probe(const SweepInput& input, const FixedTickConfig& tick, BoneModel& bone, SettingFigures& figures,
           Durations& durations) {
    ErrorSum errors;
    std::vector<double> by_place;
    NoiseSum noise;
    figures.closed_energy = INFINITY;
    for (size_t n = 0; n < input.strokes.size(); ++n) {
        const TimedRun run = runPathTimed(tick, bone, input.strokes[n].device);
        const std::vector<TickAnswer> answers = answersOf(run.records);
        errors.add(answers, input.truth[n].answers);
        ErrorSum here;
        here.add(answers, input.truth[n].answers);
        if (here.errors().ticks > 0) by_place.push_back(here.errors().force_vector);
        noise.add(answers);
        const PathEnergy energy = energyOf(answers, input.strokes[n].device);
        figures.closed_energy = std::min(figures.closed_energy, energy.at_end);
        figures.lowest_energy = std::min(figures.lowest_energy, energy.lowest);
        for (const TickRecord& record : run.records) {
            figures.max_penetration = std::max(figures.max_penetration, record.max_penetration);
            figures.faults |= record.faults;
        }
        durations.add(run);
    }
    figures.errors = errors.errors();
    const auto [best, worst] = std::ranges::minmax_element(by_place);
    if (!by_place.empty()) figures.best_and_worst_place = {*best, *worst};
    figures.noise = noise.noise();
}

void mill(const SweepInput& input, const FixedTickConfig& tick, SharedBone& shared, SettingFigures& figures,
          Durations& durations) {
    MillingRun run = millAndRestore(tick, shared.bone, shared.history, input.milling);
    TimedRun timed(std::move(run.records));
    for (int pass = 1; pass < kPasses; ++pass)
        timed.add(millAndRestore(tick, shared.bone, shared.history, input.milling).records);
    figures.removal = {run.removed, run.swept, run.wanted};
    for (const TickRecord& record : timed.records) figures.faults |= record.faults;
    durations.add(timed);
}

SettingFigures measure(const SweepInput& input, const AccuracySettings& settings, SharedBone& shared) {
    FixedTickConfig tick{tickConfigOf(input.scene), input.tool, settings};
    EffectConfigs by_time;  // contact is measured, and what goes by time
    by_time.time_removal = tick.effects.time_removal;
    tick.effects = by_time;
    SettingFigures figures;
    figures.settings = settings;

    figures.is_in_force = settings == accuracyOf(input.scene);
    Durations probing, milling;
    probe(input, tick, shared.bone, figures, probing);
    if (!input.milling.empty()) mill(input, tick, shared, figures, milling);
    figures.plane = input.plane.measure(settings);
    figures.probing_times = timesOf(probing.shortest);
    figures.milling_times = timesOf(milling.shortest);
    probing.add(milling);
    figures.ticks = probing.shortest.size();
    figures.times = timesOf(std::move(probing.shortest));
    figures.longest_times = timesOf(std::move(probing.longest));
    return figures;
}

[[noreturn]] void refuseSetting(const std::string& name, const std::vector<AccuracySettings>& all) {
    std::string known;
    for (const AccuracySettings& settings : all) known.append("\n  ").append(settingsName(settings));
    throw UserError("--setting " + name + ": there is no such setting; there are" + known);
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

std::vector<AccuracySettings> settingsNamed(const std::vector<std::string>& names,
                                            const std::vector<AccuracySettings>& all,
                                            const AccuracySettings& of_scene) {
    if (names.empty()) return all;
    Choices chosen;
    for (const std::string& name : names) {
        const auto isNamed = [&](const AccuracySettings& settings) {
            return strcasecmp(settingsName(settings).c_str(), name.c_str()) == 0;
        };
        const auto found = std::ranges::find_if(all, isNamed);
        if (found == all.end()) refuseSetting(name, all);
        chosen.add(*found);
    }
    chosen.add(of_scene);
    return chosen.list;
}

scene::Scene sceneWith(const scene::Scene& scene, const AccuracySettings& settings) {
    scene::Scene changed = scene;
    setTo(*changed.mutable_accuracy(), settings);
    return changed;
}

std::vector<SettingFigures> sweep(const SweepInput& input, const std::vector<AccuracySettings>& settings,
                                  const SweepProgress& progress) {
    std::map<std::vector<std::pair<int, ShellNormals>>, std::vector<size_t>> groups;  // by shell levels
    for (size_t n = 0; n < settings.size(); ++n) {
        std::vector<std::pair<int, ShellNormals>> levels;
        for (const ShellLevel& level : shellConfigOf(sceneWith(input.scene, settings[n])).levels)
            levels.emplace_back(level.factor, level.normals);
        groups[levels].push_back(n);
    }
    std::vector<SettingFigures> all(settings.size());
    size_t done = 0;
    for (const auto& [levels, members] : groups) {
        SharedBone shared(input, shellConfigOf(sceneWith(input.scene, settings[members.front()])));
        for (const size_t n : members) {
            all[n] = measure(input, settings[n], shared);
            all[n].name = settingsName(settings[n]);
            progress(all[n], ++done);
        }
    }
    return all;
}

}  // namespace bonemill
