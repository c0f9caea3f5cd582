#include "haptic_server/offline/effect_cost.h"

#include <algorithm>
#include <cmath>

#include "common/rt/clock.h"
#include "haptic_server/tick/fixed_tick.h"

namespace bonemill {
namespace {

class PathIo final : public TickIo {
  public:
    explicit PathIo(std::span<const DeviceInput> path) : path_(path) { records.reserve(path.size()); }

    bool read(DeviceInput& input) noexcept override {
        if (next_ == path_.size()) return false;
        input = path_[next_++];
        input.start_ns = monotonicNowNs();
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return monotonicNowNs(); }
    int64_t now() noexcept override { return monotonicNowNs(); }
    void push(const TickRecord& record) noexcept override { records.push_back(record); }  // reserved above

    std::vector<TickRecord> records;

  private:
    std::span<const DeviceInput> path_;
    size_t next_ = 0;
};

double medianOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
}

TickTimes timesOf(const std::vector<TickRecord>& records, const std::vector<size_t>& which) {
    std::vector<int64_t> ns;
    for (const size_t n : which) ns.push_back(records[n].compute_ns);
    std::sort(ns.begin(), ns.end());
    const auto at = [&ns](double share) {
        return microsecondsOfNs(double(ns[std::min(ns.size() - 1, size_t(share * double(ns.size())))]));
    };
    return {at(0.5), at(0.99), at(0.999), at(1)};
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
            median(rounds, &TickTimes::p999), median(rounds, &TickTimes::max)};
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

// One path on one bone, which is put back before each run.
class Bench {
  public:
    Bench(const FixedTickConfig& config, BoneModel& bone, std::span<const DeviceInput> path)
        : config_(config), bone_(bone), path_(path), history_(bone) {
        busy_ = busyTicks(run(config.effects));  // and opens the bricks that milling needs
    }
    TickTimes times(const EffectConfigs& effects) { return timesOf(run(effects), busy_); }
    void putBack() {
        history_.restore();
        for (bool shell_is_complete = true; history_.restoreSome(bone_, shell_is_complete);) {
        }
    }
    size_t busyCount() const { return busy_.size(); }

  private:
    std::vector<TickRecord> run(const EffectConfigs& effects) {
        putBack();
        FixedTickConfig config = config_;
        config.effects = effects;
        return recordsOf(config, bone_, path_);
    }

    const FixedTickConfig& config_;
    BoneModel& bone_;
    std::span<const DeviceInput> path_;
    BoneHistory history_;
    std::vector<size_t> busy_;
};

}  // namespace

std::vector<TickRecord> recordsOf(const FixedTickConfig& config, BoneModel& bone,
                                  std::span<const DeviceInput> path) {
    PathIo io(path);
    FixedTick(config, bone).run(io);
    return std::move(io.records);
}

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
