#include "tests/bench/bench_tick.h"

#include <algorithm>
#include <cstdio>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/half_block.h"
#include "tests/bench/leaf_cells.h"
#include "tests/bench/neighbour.h"
#include "tests/support/scripted_io.h"
#include "tests/support/typical_effects.h"

namespace bonemill::bench {
namespace {

constexpr double kCouplingStiffness = 1000;  // N/m
// The burr stays in contact: this hand is faster than it removes.
constexpr double kRemovalRate = 60 * kDensityCountsPerUnit;  // counts/s

FixedTickConfig configOf(const TickCase& c, const ToolModel& tool) {
    FixedTickConfig config;
    config.tool.model = &tool;
    config.tool.burr.radius = c.burr_radius;
    config.accuracy = presetSettings(c.preset);
    config.gradient.coupling.translation_stiffness = kCouplingStiffness;
    config.coupling.translation_stiffness = kCouplingStiffness;
    if (c.mills) config.effects.time_removal = TimeRemovalConfig{.rate = kRemovalRate};
    TickBudget::apply(config.dt, config.gradient, config.most_milled_cells);
    return config;
}

}  // namespace

TickFigures measureTicks(const TickCase& c) {
    BoneModel bone(halfBlock(c.edge, c.spacing), Eigen::Vector3i::Constant(kLeafCells),
                   {.levels = {{presetSettings(c.preset).shell_factor, ShellNormals::kTrilinear}}});
    ToolConfig tool_config;
    tool_config.burr_radius = c.burr_radius;
    const ToolModel tool = buildTool(tool_config).model;
    const WeaveConfig way{.burr_radius = c.burr_radius,
                          .depth = c.depth,
                          .clearance = std::max(0.5e-3, -c.depth),
                          .ticks = c.ticks,
                          .mills = c.mills};
    test::ScriptedIo io(weave(bone.volume, way));
    FixedTick tick(configOf(c, tool), bone);
    io.lead(tick);
    return figuresOf(io.records, size_t(way.approach_ticks));
}

void addTickCommand(CLI::App& app) {
    struct Options {
        TickCase tick_case;
        double voxel_mm = 0.096, burr_radius_mm = 3, depth_mm = 1;
        std::string preset = "balanced", json;
        bool is_still = false;
        int runs = 1, neighbour_mb = 0;
    };
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("tick", "whole ticks of a burr that mills a flat block");
    command->add_option("--volume", o->tick_case.edge, "voxels per edge")->check(CLI::Range(32, 1024));
    command->add_option("--voxel-mm", o->voxel_mm)->check(CLI::Range(0.01, 10.0));
    command->add_option("--burr-radius-mm", o->burr_radius_mm)->check(CLI::Range(0.1, 20.0));
    command
        ->add_option("--depth-mm", o->depth_mm, "of the hand below the face; negative: the burr stays above")
        ->check(CLI::Range(-20.0, 5.0));
    command->add_option("--preset", o->preset, "One of " + presetNames());
    command->add_option("--ticks", o->tick_case.ticks)->check(CLI::Range(1000, 1'000'000));
    command->add_option("--runs", o->runs, "repeat, and take each figure's median")->check(CLI::Range(1, 99));
    command
        ->add_option("--neighbour-mb", o->neighbour_mb,
                     "beside the tick another thread goes through so much memory, as fast as it can")
        ->check(CLI::Range(0, 4096));
    command->add_flag("--no-mill", o->is_still, "press and slide only, without any effect");
    addJsonOption(*command, o->json);
    command->callback([o] {
        const auto preset = presetOfName(o->preset);
        if (!preset) throw UserError("--preset " + o->preset + ": one of " + presetNames());
        o->tick_case.preset = *preset;
        o->tick_case.spacing = o->voxel_mm * kMillimetre;
        o->tick_case.burr_radius = o->burr_radius_mm * kMillimetre;
        o->tick_case.depth = o->depth_mm * kMillimetre;
        o->tick_case.mills = !o->is_still;
        const Neighbour neighbour(size_t(o->neighbour_mb) << 20);
        std::vector<nlohmann::json> runs;
        Table table({"tick, us", "mean", "p50", "p99", "p99.9", "max"});
        for (int n = 1; n <= o->runs; ++n) {
            const TickFigures figures = measureTicks(o->tick_case);
            const std::string run = "run " + std::to_string(n) + ": ";
            table.add({run + "whole"}, figures.whole);
            table.add({run + "force"}, figures.force);
            table.add({run + "milling"}, figures.milling);
            runs.push_back(toJson(figures));
        }
        const nlohmann::json json = medianOf(runs);
        table.print();
        std::printf(
            "contacts %.0f, candidates %.0f, iterations %.2f, removed voxels per tick %.2f, largest force "
            "step %.4f N, faults "
            "%s\n",
            json["contacts_mean"].get<double>(), json["candidates_mean"].get<double>(),
            json["iterations_mean"].get<double>(), json["removed_voxels_per_tick"].get<double>(),
            json["force_step_max_n"].get<double>(), faultNames(json["faults"].get<uint32_t>()).c_str());
        writeJson(o->json, json);
    });
}

}  // namespace bonemill::bench
