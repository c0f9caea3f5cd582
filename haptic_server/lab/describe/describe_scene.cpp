#include "haptic_server/lab/describe/describe_scene.h"

#include <algorithm>
#include <sstream>

#include "common/base/units.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_handle.h"
#include "common/config/scene_table.h"
#include "haptic_server/lab/describe/describe_effects.h"
#include "haptic_server/lab/describe/describe_task.h"
#include "haptic_server/lab/describe/effect_cost.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/recording/statistics/tick_times.h"
#include "haptic_server/scans/find_bone/bone_box.h"
#include "haptic_server/scene/setup/coupling_text.h"
#include "haptic_server/scene/setup/scene_region.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {
namespace {

constexpr int kMeasuredTicks = 4000;
constexpr int kRounds = 5;

// The device goes straight along the scenario's waypoints, spread over kMeasuredTicks of this length (s).
std::vector<DeviceInput> pathOf(const scene::SimulatedOperator& scenario, double dt) {
    const int waypoints = scenario.waypoint_size();
    std::vector<DeviceInput> path(waypoints > 0 ? kMeasuredTicks : 0);
    for (int tick = 0; tick < int(path.size()); ++tick) {
        const double at = double(tick) / kMeasuredTicks * std::max(1, waypoints - 1);
        const int from = std::min(int(at), waypoints - 1);
        const Pose a = poseOf(scenario.waypoint(from));
        const Pose b = poseOf(scenario.waypoint(std::min(from + 1, waypoints - 1)));
        DeviceInput& input = path[size_t(tick)];
        input.X_WT_device = {a.position + (at - from) * (b.position - a.position),
                             a.rotation.slerp(at - from, b.rotation)};
        input.buttons = (scenario.waypoint(from).remove() ? kButtonRemove : 0u) |
                        (scenario.waypoint(from).add() ? kButtonAdd : 0u);
        input.t_s = tick * dt;
    }
    return path;
}

std::string percentilesUs(std::vector<int64_t> durations_ns) {
    const TickTimes times = timesOf(std::move(durations_ns));
    std::ostringstream text;
    text << "p50 " << times.p50 << " us, p99 " << times.p99 << " us";
    return text.str();
}

std::string describeLevels(const PointShell& shell) {
    std::string text;
    for (int level = 0; level < shell.levelCount(); ++level)
        text += (level > 0 ? "; " : "") + std::to_string(shell.pointCount(level)) +
                " points, scaling factor " + std::to_string(shell.scalingFactor(level));
    return text;
}

std::string textOf(const Eigen::AlignedBox3d& box) {
    const Eigen::IOFormat row(4, 0, " ", " ");
    std::ostringstream text;
    text << "(" << (box.min() * kPerMillimetre).transpose().format(row) << ") .. ("
         << (box.max() * kPerMillimetre).transpose().format(row) << ") mm";
    return text.str();
}

// Where the bone lies in W, and in what pieces: what a device, a region and a camera are placed by.
void describePlace(const LoadedScene& loaded, const Simulation& simulation, std::ostream& out) {
    const VoxelVolume& volume = simulation.bone->volume;
    const VolumeGeometry& geometry = volume.geometry();
    const auto inWorld = [&](const Eigen::AlignedBox3d& box_V) {
        Eigen::AlignedBox3d box_W;
        for (int corner = 0; corner < 8; ++corner)
            box_W.extend(geometry.X_WV * box_V.corner(Eigen::AlignedBox3d::CornerType(corner)));
        return box_W;
    };
    const IndexBox all{Eigen::Vector3i::Zero(), geometry.dims.array() - 1};
    out << "volume in W: " << textOf(inWorld(placesOf(all, geometry.spacing))) << '\n';
    const Eigen::AlignedBox3d bone = placesOf(boneBox(volume), geometry.spacing);
    if (bone.isEmpty()) return void(out << "bone in W: none\n");
    const Eigen::Vector3d middle = geometry.X_WV * Eigen::Vector3d(bone.center()) * kPerMillimetre;
    out << "bone in W: " << textOf(inWorld(bone)) << ", middle (" << middle.transpose() << ") mm\n";
    if (!loaded.scene.volume().has_region() && !choosesPieces(loaded.scene))
        out << "pieces of bone, for volume.drop_piece:\n  " << listPieces(volume) << '\n';
}

void describeTools(const Simulation& simulation, std::ostream& out) {
    int number = 0;
    for (const SceneTool& tool : simulation.tools) {
        const SdfGrid& grid = tool.built.model.grid();
        ++number;
        out << "tool " << number << " '" << tool.name << "'" << (number == 1 ? ", in use at the start" : "")
            << ": distance grid " << grid.nodes().transpose() << " nodes of "
            << grid.spacing() * kPerMillimetre << " mm, burr radius " << tool.burr.radius * kPerMillimetre
            << " mm, pull of the coupling at most " << tool.saturation_force << " N\n";
    }
}

void describeBudget(const Simulation& simulation, std::ostream& out) {
    const TickConfig& tick = simulation.tick;
    out << "most point tests in a tick: " << tick.gradient.most_point_tests
        << (simulation.accuracy.law == ContactLaw::kGradient ? "\n" : ", without effect on this law\n")
        << "most milled cells in a tick: " << tick.most_milled_cells << '\n';
}

void describeCost(const std::vector<TickRecord>& records, std::ostream& out) {
    if (records.empty()) {
        out << "cost per tick: not measured, the scene has no simulated_operator.waypoint to follow\n";
        return;
    }
    std::vector<int64_t> force, milling;
    for (const TickRecord& record : records) {
        force.push_back(record.force_ns);
        if (record.buttons) milling.push_back(record.compute_ns - record.force_ns);
    }
    out << "cost per tick on this machine, along the scenario's waypoints (" << records.size() << " ticks):\n"
        << "  contact, coupling, equilibrium: " << percentilesUs(force) << '\n';
    if (!milling.empty()) out << "  removal, addition and shell refresh: " << percentilesUs(milling) << '\n';
}

DeviceCapabilities aresOf(const scene::Scene& scene) {
    DeviceCapabilities ares{};
    ares.abilities = kAbilityForce | kAbilityTorque | kAbilityOrientation;
    ares.max_force = scene.device().max_force_n();
    ares.max_torque = scene.device().max_torque_nmm() * kMilli;
    ares.handle = handleDynamicsOf(scene);
    return ares;
}

}  // namespace

std::string describeScene(const std::string& scene_file) {
    const LoadedScene loaded = loadScene(scene_file);
    Simulation simulation = makeSimulation(loaded);
    const BoneModel& bone = *simulation.bone;
    std::ostringstream out;
    out << "scene '" << loaded.scene.name() << "', preset " << settingsName(simulation.accuracy) << '\n';
    for (const std::string& remark : simulation.remarks) out << "  " << remark << '\n';
    for (const std::string& warning : simulation.warnings) out << "  warning: " << warning << '\n';
    const Eigen::Vector3d mm = bone.volume.spacing() * kPerMillimetre;
    out << "volume: " << bone.volume.dims().transpose() << " voxels of " << mm.transpose()
        << " mm, iso-value " << simulation.mapping.iso_value << ", window " << simulation.mapping.low
        << " .. " << simulation.mapping.high << '\n'
        << "octree: " << bone.lattice.leavesPerAxis().transpose() << " leaves of "
        << bone.lattice.leafCells().transpose() << " cells, " << bone.lattice.levelCount() << " levels\n"
        << "point-shell: " << describeLevels(bone.shell) << '\n';
    describePlace(loaded, simulation, out);
    describeTools(simulation, out);
    describeTask(simulation, out);
    describeBudget(simulation, out);
    out << "with the scene's ARES: " << couplingText(simulation.tick, aresOf(loaded.scene)) << '\n';
    const std::vector<DeviceInput> path = pathOf(loaded.scene.simulated_operator(), simulation.tick.dt);
    const EffectCosts costs = measureEffectCosts(simulation.fixedTick(), *simulation.bone, path, kRounds);
    out << describeEffects(loaded.scene, path.empty() ? nullptr : &costs);
    describeCost(runPath(simulation.fixedTick(), *simulation.bone, path), out);
    out << "\nwhat the scene file sets (all else has its default):\n"
        << loaded.scene.DebugString() << "\nevery field, its unit, default and range:\n"
        << describeDefaults();
    return out.str();
}

}  // namespace bonemill
