// Measures the cost of a tick on the thesis' tooth while milling a corridor, by preset, scaling factor and
// octree leaf size, for `haptic_bench presets`.
//
// All settings in turn in the same process, several rounds, of which each figure is the median.
#include <memory>
#include <string>
#include <vector>

#include "common/rt/clock.h"
#include "common/rt/latency_histogram.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/laws/all_laws.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/support/scripted_io.h"
#include "tests/support/typical_effects.h"
#include "tests/support/whole_densities.h"

namespace bonemill::bench {
namespace {

struct Setting {
    std::string name;
    Preset preset;
    int scaling_factor;
    bool has_thesis_octree;  // depth 3; else leaves of 16³ cells
};
// The thesis' octree has depth 3, so have all but one.
const Setting kSettings[] = {
    {"thesis_2012", Preset::kThesis2012, 3, true},
    {"thesis_2012, s = 1", Preset::kThesis2012, 1, true},
    {"fast", Preset::kFast, 1, true},
    {"balanced", Preset::kBalanced, 1, true},
    {"balanced, leaves of 16 cells", Preset::kBalanced, 1, false},
    {"exact", Preset::kExact, 1, true},
    {"proxy_3dof", Preset::kProxy3Dof, 1, true},
    {"vps", Preset::kVps, 1, true},
    {"penalty_sdf", Preset::kPenaltySdf, 1, true},
    {"constraint", Preset::kConstraint, 1, true},
};
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

void addCosts(Table& table, const std::string& name, const nlohmann::json& cost) {
    std::vector<std::string> cells{name};
    for (const char* part : {"force", "milling", "whole"})
        for (const char* key : {"p50", "p99", "p999"}) cells.push_back(number(cost[part][key].get<double>()));
    table.add(cells);
}

void comparePresets(int rounds, const std::string& json_path) {
    const RawVolume scan = scanTooth(toothGrid(), {});
    const ToolModel tool = buildTool({}).model;
    std::vector<nlohmann::json> runs(size_t(rounds), nlohmann::json::object());
    for (nlohmann::json& run : runs)
        for (const Setting& setting : kSettings) {
            Cost cost;
            measure(setting, scan, tool, cost);
            run[setting.name] = {{"force", microseconds(cost.force)},
                                 {"milling", microseconds(cost.milling)},
                                 {"whole", microseconds(cost.whole)}};
        }
    const nlohmann::json medians = medianOf(runs);
    Table table(
        {"us", "force p50", "p99", "p99.9", "milling p50", "p99", "p99.9", "whole p50", "p99", "p99.9"});
    for (const Setting& setting : kSettings) addCosts(table, setting.name, medians[setting.name]);
    table.print();
    writeJson(json_path, medians);
}

}  // namespace

void addPresetsCommand(CLI::App& app) {
    struct Options {
        std::string json;
        int rounds = 3;
    };
    auto o = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("presets", "whole ticks in the tooth's corridor, preset by preset");
    command->add_option("--rounds", o->rounds, "of all settings in turn")->check(CLI::Range(1, 99));
    addJsonOption(*command, o->json);
    command->callback([o] { comparePresets(o->rounds, o->json); });
}

}  // namespace bonemill::bench
