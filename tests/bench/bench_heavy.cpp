// Machines differ threefold, so what counts is the ratio to the corridor's ticks of the same round: all cases
// in turn, each figure and ratio the median of the rounds. Times are the processor's, so that another program
// on the core does not count.
#include <time.h>

#include <cstdio>
#include <memory>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "device_daemon/ares/emulator/scenario.h"
#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/recording/statistics/tick_times.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/half_block.h"
#include "tests/support/every_effect_scene.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::bench {
namespace {

constexpr double kBlockMm = 34, kWideRadiusMm = 3.5, kQuick = 50e-3;  // m/s
constexpr double kWideSpeedRpm = 60000;

struct HeavyOptions {
    int rounds = 5;
    double slowed = 0;
    std::string only, scene, json;
};

std::string shipped(const std::string& name) {
    return test::sourceDir() + "/deploy/scenes/" + name + ".textproto";
}

int64_t processorNs() {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return used.tv_sec * kNsPerSecond + used.tv_nsec;
}

class TimedIo final : public TickIo {
  public:
    // The processor is `slowed` times as slow, and ticks have a period of dt seconds; 0: they have all time.
    TimedIo(std::span<const DeviceInput> path, double slowed, double dt)
        : path_(path), slowed_(slowed), period_ns_(int64_t(dt * double(kNsPerSecond))) {}

    bool read(DeviceInput& input) noexcept override {
        if (path_.empty()) return false;
        input = path_.front();
        path_ = path_.subspan(1);
        input.start_ns = now();
        input.deadline_ns = slowed_ > 0 ? input.start_ns + period_ns_ : INT64_MAX;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return now(); }
    int64_t now() noexcept override { return int64_t((slowed_ > 0 ? slowed_ : 1) * double(processorNs())); }

  private:
    std::span<const DeviceInput> path_;
    double slowed_;
    int64_t period_ns_;
};

// What is run is timed on one bone, which is put back before each round.
class HeavyCase {
  public:
    HeavyCase(std::string name, SceneSetup simulation, FixedTickConfig config, std::vector<DeviceInput> path)
        : name_(std::move(name)),
          simulation_(std::move(simulation)),
          config_(std::move(config)),
          path_(std::move(path)),
          history_(std::make_unique<BoneHistory>(*simulation_.bone)) {}

    const std::string& name() const { return name_; }
    // {p50, p99, p999, max} of ticks in contact, µs; their number, and the share beyond 0.8 of the period.
    nlohmann::json run(double slowed) {
        history_->restore();
        history_->restoreAll(*simulation_.bone);
        std::vector<int64_t> durations_ns, forces_ns;
        size_t late = 0, overruns = 0;
        uint32_t faults = 0, contacts = 0;
        TimedIo io(path_, slowed, config_.dt);
        FixedTick(config_, *simulation_.bone).run(io, [&](const TickRecord& record) {
            faults |= record.faults;
            overruns += (record.faults & kFaultOverrun) != 0;
            if (record.contacts == 0) return;
            durations_ns.push_back(record.compute_ns);
            forces_ns.push_back(record.force_ns);
            contacts = std::max(contacts, record.contacts);
            late += double(record.compute_ns) > 0.8 * config_.dt * double(kNsPerSecond);
        });
        const size_t ticks = durations_ns.size();
        const TickTimes us = timesOf(std::move(durations_ns));
        return {{"force_p99", timesOf(std::move(forces_ns)).p99},
                {"p50", us.p50},
                {"p99", us.p99},
                {"p999", us.p99_9},
                {"max", us.max},
                {"ticks", ticks},
                {"late", late},
                {"most_contacts", contacts},
                {"faults", faults},
                {"overruns", overruns}};
    }

  private:
    std::string name_;
    SceneSetup simulation_;
    FixedTickConfig config_;
    std::vector<DeviceInput> path_;
    std::unique_ptr<BoneHistory> history_;
};

// The scene's own hand holds the tool without giving way.
HeavyCase sceneCase(const std::string& name, const std::string& file) {
    const LoadedScene loaded = loadScene(file);
    const OperatorPath hand = scenarioOf(loaded.scene).path;
    SceneSetup simulation = setUpScene(loaded);
    const FixedTickConfig config = simulation.fixedTick();
    std::vector<DeviceInput> path(size_t(hand.duration() / config.dt), DeviceInput{});
    for (size_t n = 0; n < path.size(); ++n) {
        path[n].t_s = double(n) * config.dt;
        const HandTarget target = hand.at(path[n].t_s);
        path[n].X_WT_device = simulation.X_WD * target.X_DT;
        path[n].buttons = target.buttons;
    }
    return {name, std::move(simulation), config, std::move(path)};
}

HeavyCase shippedCase(const std::string& name) {
    return sceneCase(name, shipped(name));
}

enum class WideEffects { kNone, kEnergyRemoval, kAllOfMastoid };
struct Wide {
    WideEffects effects;
    const char* name;
};
constexpr Wide kWide[] = {{WideEffects::kNone, "no effect"},
                          {WideEffects::kEnergyRemoval, "energy_removal alone"},
                          {WideEffects::kAllOfMastoid, "all of mastoid's"}};

SceneSetup wideSetup(double voxel_mm, WideEffects which) {
    const test::EveryEffectBlock block{.edge = int(kBlockMm / voxel_mm),
                                       .voxel_mm = voxel_mm,
                                       .burr_radius_mm = kWideRadiusMm,
                                       .protected_depth_mm = 6};
    scene::Scene scene = test::everyEffectScene(block, test::kByEnergy);
    scene.mutable_tool(0)->set_speed_rpm(kWideSpeedRpm);
    scene::Effects effects = loadScene(shipped("mastoid")).scene.effects();
    effects.clear_bleeding(), effects.clear_pulse();  // they name materials that are not here
    if (which != WideEffects::kAllOfMastoid) {
        scene.mutable_effects()->Clear();
        *scene.mutable_effects()->mutable_energy_removal() = effects.energy_removal();
        scene.mutable_material()->Clear();
        scene.mutable_volume()->clear_label_path();
    } else {
        *scene.mutable_effects() = effects;
    }
    const test::TemporaryFolder folder;
    test::writeBlock(folder.path().string(), block);
    test::writeScene(folder / "scene.textproto", scene);
    return setUpScene(loadScene(folder / "scene.textproto"));
}

// The ball sinks in to its middle, then goes quickly over the face, row beside row.
std::vector<DeviceInput> rowsOver(const VoxelVolume& volume, double dt) {
    constexpr double kSink = 7e-3, kHalfRow = 12e-3, kRowStep = 5e-3;  // m/s, m
    constexpr int kRows = 4;
    const Eigen::Vector3d middle = middleOfFace(volume);
    const double radius = kWideRadiusMm * kMillimetre;
    std::vector<Eigen::Vector3d> corners{middle + Eigen::Vector3d(-kHalfRow, -1.5 * kRowStep, radius)};
    corners.push_back(corners[0] - Eigen::Vector3d(0, 0, radius));
    for (int row = 0; row < kRows; ++row) {
        corners.push_back(corners.back() +
                          Eigen::Vector3d(row % 2 == 0 ? 2 * kHalfRow : -2 * kHalfRow, 0, 0));
        if (row + 1 < kRows) corners.push_back(corners.back() + Eigen::Vector3d(0, kRowStep, 0));
    }
    const Eigen::Quaterniond upright(M_SQRT1_2, M_SQRT1_2, 0, 0);
    std::vector<DeviceInput> path;
    for (size_t n = 1; n < corners.size(); ++n) {
        const Eigen::Vector3d way = corners[n] - corners[n - 1];
        const int ticks = int(way.norm() / ((n == 1 ? kSink : kQuick) * dt));
        for (int tick = 1; tick <= ticks; ++tick) {
            DeviceInput input{};
            input.t_s = double(path.size()) * dt;
            input.X_WT_device = volume.geometry().X_WV * Pose{corners[n - 1] + way * tick / ticks, upright};
            input.buttons = kButtonRemove;
            path.push_back(input);
        }
    }
    return path;
}

HeavyCase wideCase(const std::string& name, double voxel_mm, WideEffects effects) {
    SceneSetup simulation = wideSetup(voxel_mm, effects);
    FixedTickConfig config = simulation.fixedTick();
    if (effects == WideEffects::kNone) config.effects = {};
    std::vector<DeviceInput> path = rowsOver(simulation.bone->volume, config.dt);
    return {name, std::move(simulation), config, std::move(path)};
}

void print(const nlohmann::json& medians, const std::vector<HeavyCase>& cases) {
    Table table({"ticks in contact, us", "p50", "p99", "p99.9", "max", "force p99", "p99 / corridor's",
                 "ticks", "above 0.8 ms", "overruns", "contacts", "faults"});
    for (const HeavyCase& one : cases) {
        const nlohmann::json& us = medians[one.name()];
        std::vector<std::string> row{one.name()};
        for (const char* key : {"p50", "p99", "p999", "max", "force_p99", "p99_ratio", "ticks", "late",
                                "overruns", "most_contacts"})
            row.push_back(number(us[key].get<double>()));
        row.push_back(faultNames(us["faults"].get<uint32_t>()));
        table.add(std::move(row));
    }
    table.print();
}

// The first is what the others are measured by.
std::vector<HeavyCase> casesWith(const HeavyOptions& o) {
    std::vector<HeavyCase> cases;
    const auto add = [&](const std::string& name, auto&& make) {
        if (cases.empty() || name.find(o.only) != std::string::npos) cases.push_back(make(name));
    };
    add("tooth_corridor", shippedCase);
    if (!o.scene.empty()) {
        cases.push_back(sceneCase(o.scene, o.scene));
        return cases;
    }
    add("pedicle", shippedCase);
    for (const double voxel_mm : {0.2, 0.125})
        for (const Wide& wide : kWide)
            add("R 3.5 at " + number(voxel_mm) + " mm, " + wide.name,
                [&](const std::string& name) { return wideCase(name, voxel_mm, wide.effects); });
    return cases;
}

void measure(const HeavyOptions& o) {
    std::vector<HeavyCase> cases = casesWith(o);
    for (HeavyCase& one : cases) one.run(0);  // opens the bricks that milling needs
    std::vector<nlohmann::json> runs;
    for (int round = 0; round < o.rounds; ++round) {
        nlohmann::json run;
        for (HeavyCase& one : cases) {
            run[one.name()] = one.run(o.slowed);
            run[one.name()]["p99_ratio"] =
                run[one.name()]["p99"].get<double>() / run[cases[0].name()]["p99"].get<double>();
        }
        runs.push_back(std::move(run));
    }
    const nlohmann::json medians = medianOf(runs);
    print(medians, cases);
    writeJson(o.json, medians);
}

}  // namespace

void addHeavyCommand(CLI::App& app) {
    auto o = std::make_shared<HeavyOptions>();
    CLI::App* command = app.add_subcommand(
        "heavy", "scenes with many effects and wide burrs, in multiples of the tooth's corridor");
    command->add_option("--rounds", o->rounds, "of all cases in turn")->check(CLI::Range(1, 999));
    command
        ->add_option(
            "--slowed", o->slowed,
            "as on a processor that is so many times as slow, with deadlines, so that ticks put work "
            "off; 0: without")
        ->check(CLI::Range(0.0, 100.0));
    command->add_option("--only", o->only, "beside the corridor only cases with this in their name");
    command->add_option("--scene", o->scene, "beside the corridor only this scene, with its own hand");
    addJsonOption(*command, o->json);
    command->callback([o] { measure(*o); });
}

}  // namespace bonemill::bench
