#include "haptic_server/lab/accuracy_report/sweep.h"

#include <algorithm>
#include <map>
#include <memory>

#include "haptic_server/lab/accuracy_report/sweep_settings.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {
namespace {

// Settings that keep the same shell levels up to date share one bone; milling puts it back as it was.
struct SharedBone {
    BoneModel bone;
    BoneHistory history;

    SharedBone(const SweepInput& input, const ShellConfig& shell)
        : bone(VoxelVolume(input.volume), input.leaf_cells, shell), history(bone) {}
};

void addTimes(const RunRecords& records, std::vector<int64_t>& durations) {
    for (const TickRecord& record : records) durations.push_back(record.compute_ns);
}

void probe(const SweepInput& input, const FixedTickConfig& tick, BoneModel& bone, SettingFigures& figures,
           std::vector<int64_t>& durations) {
    ErrorSum errors;
    NoiseSum noise;
    figures.closed_energy = INFINITY;
    for (size_t n = 0; n < input.strokes.size(); ++n) {
        const RunRecords records = runPathTimed(tick, bone, input.strokes[n].device);
        const std::vector<TickAnswer> answers = answersOf(records);
        errors.add(answers, input.truth[n].answers);
        noise.add(answers);
        const PathEnergy energy = energyOf(answers, input.strokes[n].device);
        figures.closed_energy = std::min(figures.closed_energy, energy.at_end);
        figures.lowest_energy = std::min(figures.lowest_energy, energy.lowest);
        for (const TickRecord& record : records) {
            figures.max_penetration = std::max(figures.max_penetration, record.max_penetration);
            figures.faults |= record.faults;
        }
        addTimes(records, durations);
    }
    figures.errors = errors.errors();
    figures.noise = noise.noise();
}

void mill(const SweepInput& input, const FixedTickConfig& tick, SharedBone& shared, SettingFigures& figures,
          std::vector<int64_t>& durations) {
    MillingRun run = millAndRestore(tick, shared.bone, shared.history, input.milling);
    for (int pass = 1; pass < kPasses; ++pass)
        keepShorterTimes(run.records,
                         millAndRestore(tick, shared.bone, shared.history, input.milling).records);
    figures.removal = {run.removed, run.swept, run.wanted};
    for (const TickRecord& record : run.records) figures.faults |= record.faults;
    addTimes(run.records, durations);
}

SettingFigures measure(const SweepInput& input, const AccuracySettings& settings, SharedBone& shared) {
    FixedTickConfig tick{tickConfigOf(input.scene), input.tool, settings};
    EffectConfigs by_time;  // contact is measured, and what goes by time
    by_time.time_removal = tick.effects.time_removal;
    tick.effects = by_time;
    SettingFigures figures;
    figures.settings = settings;

    figures.is_in_force = settings == accuracyOf(input.scene);
    std::vector<int64_t> probing, milling;
    probe(input, tick, shared.bone, figures, probing);
    if (!input.milling.empty()) mill(input, tick, shared, figures, milling);
    figures.plane = input.plane.measure(settings);
    figures.probing_times = timesOf(probing);
    figures.milling_times = timesOf(milling);
    probing.insert(probing.end(), milling.begin(), milling.end());
    figures.ticks = probing.size();
    figures.times = timesOf(std::move(probing));
    return figures;
}

}  // namespace

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
