#include "haptic_server/lab/describe/effect_cost.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/lab/simulate/run_path.h"

namespace bonemill {
namespace {

double medianOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
}

TickTimes timesOfTicks(const std::vector<TickRecord>& records, const std::vector<size_t>& which) {
    std::vector<int64_t> durations_ns;
    for (const size_t n : which) durations_ns.push_back(records[n].compute_ns);
    return timesOf(std::move(durations_ns));
}

std::vector<size_t> busyTicks(const std::vector<TickRecord>& records) {
    std::vector<size_t> busy, all;
    for (size_t n = 0; n < records.size(); ++n) {
        all.push_back(n);
        if (records[n].contacts > 0 || records[n].buttons != 0) busy.push_back(n);
    }
    return busy.empty() ? all : busy;
}

using Rounds = std::vector<TickTimes>;

double median(const Rounds& rounds, double TickTimes::*figure) {
    std::vector<double> values;
    for (const TickTimes& times : rounds) values.push_back(times.*figure);
    return medianOf(std::move(values));
}

TickTimes median(const Rounds& rounds) {
    return {median(rounds, &TickTimes::p50), median(rounds, &TickTimes::p99),
            median(rounds, &TickTimes::p99_9), median(rounds, &TickTimes::max)};
}

std::vector<double> differences(const Rounds& a, const Rounds& b, double TickTimes::*figure) {
    std::vector<double> values;
    for (size_t n = 0; n < a.size(); ++n) values.push_back(a[n].*figure - b[n].*figure);
    return values;
}

double largest(const std::vector<double>& values) {
    double most = 0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
}

// Runs one path on one bone, which is put back before each run.
class Bench {
  public:
    Bench(const FixedTickConfig& config, BoneModel& bone, std::span<const DeviceInput> path)
        : config_(config), bone_(bone), path_(path), history_(bone) {
        busy_ = busyTicks(run(config.effects));  // and opens the bricks that milling needs
    }
    TickTimes times(const EffectConfigs& effects) { return timesOfTicks(run(effects), busy_); }
    void putBack() {
        history_.restore();
        history_.restoreAll(bone_);
    }
    size_t busyCount() const { return busy_.size(); }

  private:
    std::vector<TickRecord> run(const EffectConfigs& effects) {
        putBack();
        FixedTickConfig config = config_;
        config.effects = effects;
        return runPath(config, bone_, path_);
    }

    const FixedTickConfig& config_;
    BoneModel& bone_;
    std::span<const DeviceInput> path_;
    BoneHistory history_;
    std::vector<size_t> busy_;
};

}  // namespace

EffectCosts measureEffectCosts(const FixedTickConfig& config, BoneModel& bone,
                               std::span<const DeviceInput> path, int rounds) {
    EffectCosts costs;
    if (path.empty()) return costs;
    const std::vector<std::string> names = effectNames(config.effects);
    if (names.empty()) return costs;
    std::vector<EffectConfigs> variants{config.effects, config.effects, EffectConfigs{}};
    for (const std::string& name : names) variants.push_back(withoutEffect(config.effects, name));
    std::vector<Rounds> times(variants.size());
    Bench bench(config, bone, path);
    for (int round = 0; round < rounds; ++round)
        for (size_t n = 0; n < variants.size(); ++n) {
            const size_t variant = (n + size_t(round)) % variants.size();  // none is always the first
            times[variant].push_back(bench.times(variants[variant]));
        }
    bench.putBack();
    costs.ticks = bench.busyCount();
    costs.all = median(times[0]);
    costs.none = median(times[2]);
    costs.noise_p50_us = largest(differences(times[0], times[1], &TickTimes::p50));
    costs.noise_p99_us = largest(differences(times[0], times[1], &TickTimes::p99));
    for (size_t n = 0; n < names.size(); ++n) {
        const Rounds& without = times[3 + n];
        costs.effects.push_back({names[n], median(without),
                                 medianOf(differences(times[0], without, &TickTimes::p50)),
                                 medianOf(differences(times[0], without, &TickTimes::p99))});
    }
    return costs;
}

}  // namespace bonemill
