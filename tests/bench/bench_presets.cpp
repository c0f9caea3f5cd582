// Measures the cost of a tick on the thesis' tooth while milling a corridor, by preset, scaling factor and
// octree leaf size, for `haptic_bench presets`.
//
// Prints p50/p99/p99.9/max in µs and the ratio of the medians to the thesis' own setting (s = 3, octree depth
// 3), all settings in turn in the same process, several rounds: quote a figure only if the rounds agree.
#include <cstdio>
#include <vector>

#include "common/rt/clock.h"
#include "common/rt/latency_histogram.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/laws/all_laws.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/bench/bench_commands.h"
#include "tests/support/scripted_io.h"
#include "tests/support/typical_effects.h"
#include "tests/support/whole_densities.h"

namespace bonemill::bench {
namespace {

struct Setting {
    const char* name;
    Preset preset;
    int scaling_factor;
    bool has_thesis_octree;  // depth 3; else leaves of 16³ cells
};
constexpr Setting kSettings[] = {
    {"thesis_2012: s=3, octree depth 3", Preset::kThesis2012, 3, true},
    {"thesis_2012, s=1, octree depth 3", Preset::kThesis2012, 1, true},
    {"fast, octree depth 3", Preset::kFast, 1, true},
    {"balanced, octree depth 3", Preset::kBalanced, 1, true},
    {"balanced, leaves of 16 cells", Preset::kBalanced, 1, false},
    {"exact, octree depth 3", Preset::kExact, 1, true},
    {"proxy_3dof, octree depth 3", Preset::kProxy3Dof, 1, true},
    {"vps, octree depth 3", Preset::kVps, 1, true},
    {"penalty_sdf, octree depth 3", Preset::kPenaltySdf, 1, true},
    {"constraint, octree depth 3", Preset::kConstraint, 1, true},
};
constexpr int kRounds = 3;
constexpr int kTicks = 6000;
// The first is above a cusp of the phantom, the second the middle of the tooth below it; the tool is upright.
const Pose kStart{{2.7e-3, -2.45e-3, 20.8e-3}, Eigen::Quaterniond(M_SQRT1_2, M_SQRT1_2, 0, 0)};
const Eigen::Vector3d kEnd(2.7e-3, -2.45e-3, 12.2e-3);

struct Cost {
    LatencyHistogram force;    // contact, coupling, equilibrium
    LatencyHistogram milling;  // milling and shell refresh
    LatencyHistogram whole;
};

void measure(const Setting& setting, const RawVolume& scan, const ToolModel& tool, Cost& cost) {
    const Eigen::Vector3i leaf_cells = setting.has_thesis_octree
                                           ? LeafLattice::leafCellsOfDepth(scan.geometry, 3)
                                           : Eigen::Vector3i::Constant(16);
    BoneModel bone(densify(scan, DensityWindow{-1000, 3000, 600}), leaf_cells,
                   {.levels = {{setting.scaling_factor}}});
    FixedTickConfig config;
    config.laws = allLaws();
    config.tool.model = &tool;
    config.effects.time_removal = test::kTimeRemoval;
    config.accuracy = presetSettings(setting.preset);
    config.accuracy.shell_factor = setting.scaling_factor;
    test::ScriptedIo io(test::straightPath(kStart, kEnd, kTicks, kButtonRemove));
    FixedTick(config, bone).run(io, [&cost](const TickRecord& record) {
        cost.force.record(record.force_ns);
        cost.milling.record(record.compute_ns - record.force_ns);
        cost.whole.record(record.compute_ns);
    });
}

void print(const char* what, const LatencyHistogram& h, const LatencyHistogram& reference) {
    const auto us = [&h](double percent) { return microsecondsOfNs(double(h.percentileNs(percent))); };
    std::printf("    %-22s p50 %7.1f  p99 %7.1f  p99.9 %7.1f  max %8.1f us   median ratio %.2f\n", what,
                us(50), us(99), us(99.9), microsecondsOfNs(double(h.maxNs())),
                double(h.percentileNs(50)) / double(reference.percentileNs(50)));
}

void comparePresets() {
    const RawVolume scan = scanTooth(toothGrid(), {});
    const ToolModel tool = buildTool({}).model;
    for (int round = 1; round <= kRounds; ++round) {
        std::printf("round %d, %d ticks each\n", round, kTicks);
        std::vector<Cost> costs(std::size(kSettings));
        for (size_t n = 0; n < costs.size(); ++n) {
            measure(kSettings[n], scan, tool, costs[n]);
            std::printf("  %s\n", kSettings[n].name);
            print("force", costs[n].force, costs[0].force);
            print("milling and shell", costs[n].milling, costs[0].milling);
            print("whole tick", costs[n].whole, costs[0].whole);
        }
    }
}

}  // namespace

void addPresetsCommand(CLI::App& app) {
    app.add_subcommand("presets", "whole ticks in the tooth's corridor, preset by preset")
        ->callback(comparePresets);
}

}  // namespace bonemill::bench
