#include "haptic_server/lab/describe/describe_scene.h"

#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "common/base/units.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_table.h"
#include "common/config/viewer_effects.h"
#include "common/text/printed_text.h"
#include "haptic_server/assessment/product/zone_tally.h"
#include "haptic_server/lab/describe/effect_cost.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/recording/statistics/tick_times.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"
#include "haptic_server/scene/setup/coupling_text.h"
#include "haptic_server/scene/setup/scene_region.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "proto/scene.pb.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string valueText(const Message& message, const FieldDescriptor& field, int index) {
    google::protobuf::TextFormat::Printer printer;
    printer.SetSingleLineMode(true);
    std::string text;
    printer.PrintFieldValueToString(message, &field, index, &text);
    return " " + text;
}

std::string valuesText(const Message& message, const FieldDescriptor& field) {
    const auto& reflection = *message.GetReflection();
    if (!field.is_repeated())
        return reflection.HasField(message, &field) || field.has_default_value()
                   ? valueText(message, field, -1)
                   : "";
    std::string text;
    for (int n = 0; n < reflection.FieldSize(message, &field); ++n) text += valueText(message, field, n);
    return text;
}

// It reads "name value, name value", as given or by default.
std::string parametersOf(const Message& message) {
    std::string text;
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
        const FieldDescriptor& field = *message.GetDescriptor()->field(i);
        const std::string values = valuesText(message, field);
        if (!values.empty()) text += (text.empty() ? "" : ", ") + field.name() + values;
    }
    return text;
}

std::string microseconds(double us) {
    return printed("%.2f us", us);
}

std::string added(double us, double noise_us) {
    return std::abs(us) > noise_us ? microseconds(us) : "below the noise of " + microseconds(noise_us);
}

const EffectCost* costOf(const std::string& name, const EffectCosts* costs) {
    if (!costs) return nullptr;
    for (const EffectCost& cost : costs->effects)
        if (cost.name == name) return &cost;
    return nullptr;
}

std::string costText(const std::string& name, const EffectCosts* costs) {
    const EffectCost* cost = costOf(name, costs);
    if (!cost) return "";
    return "; adds p50 " + added(cost->p50_us, costs->noise_p50_us) + ", p99 " +
           added(cost->p99_us, costs->noise_p99_us);
}

std::string line(const std::string& name, const std::string& parameters, const std::string& more) {
    return "  " + name + (parameters.empty() ? "" : ": " + parameters) + more + "\n";
}

std::string materialsText(const scene::Scene& scene, const EffectCosts* costs) {
    if (scene.material().empty()) return "";
    std::string text =
        line("materials", std::to_string(scene.material_size()), costText("material_stiffness", costs));
    for (const scene::Material& material : scene.material())
        text += "  " + line("material", parametersOf(material), "");
    return text;
}

// There is one line per effect that is listed: its parameters, and for those of the tick what they add to it,
// for those of the viewer that they are. `costs` is null if nothing was measured.
std::string describeEffects(const scene::Scene& scene, const EffectCosts* costs) {
    std::string text;
    const Message& effects = scene.effects();
    std::vector<const FieldDescriptor*> listed;
    effects.GetReflection()->ListFields(effects, &listed);
    for (const FieldDescriptor* field : listed) {
        const std::string parameters = parametersOf(effects.GetReflection()->GetMessage(effects, field));
        text += isViewerEffect(*field) ? line(field->name(), parameters, "; in the viewer")
                                       : line(field->name(), parameters, costText(field->name(), costs));
    }
    text += materialsText(scene, costs);
    if (text.empty()) return "effects: none\n";
    if (costs && !costs->effects.empty())
        text += "  all of them: p50 " + microseconds(costs->all.p50) + ", p99 " +
                microseconds(costs->all.p99) + "; without any: p50 " + microseconds(costs->none.p50) +
                ", p99 " + microseconds(costs->none.p99) + " (whole ticks, " + std::to_string(costs->ticks) +
                " in contact or with a button)\n";
    return "effects:\n" + text;
}

void describeRules(const JudgedTask& task, std::ostream& out) {
    for (const GateRule& gate : task.gates)
        out << "  gate: " << gate.figure_id << (gate.is_most ? " at most " : " at least ") << gate.limit
            << '\n';
    for (const ScoreRule& score : task.scores)
        out << "  sub-score: " << score.figure_id << " from 0 at " << score.worst << " to 1 at " << score.best
            << ", weight " << score.weight << '\n';
    if (!task.scores.empty())
        out << "  weights of version " << task.weights_version << ", hash " << task.weights_hash << '\n';
}

// Nothing for a scene without a task.
void describeTask(const SceneSetup& simulation, std::ostream& out) {
    if (!simulation.task) return;
    const JudgedTask& task = *simulation.task;
    const VoxelVolume& volume = simulation.bone->volume;
    const ProductCounts counts = countProduct(volume, volume, task);
    const double voxel_mm3 = volume.voxelVolume() * kPerCubicMillimetre;
    out << "task: feedback " << scene::Task::Feedback_Name(scene::Task::Feedback(task.feedback))
        << (task.is_exam ? ", an examination" : "");
    if (task.time_limit_s > 0) out << ", " << task.time_limit_s << " s";
    if (task.most_attempts > 0) out << ", " << task.most_attempts << " attempts at most";
    out << "\n  ideal" << (task.reference ? " (hidden reference): " : ": ")
        << double(counts.ideal) * voxel_mm3 << " mm3 of bone shall be gone\n";
    for (size_t n = 0; n < task.zones.size(); ++n)
        out << "  zone '" << task.zones[n].name << "', "
            << scene::Task::Role_Name(scene::Task::Role(task.zones[n].role)) << ": "
            << double(counts.zones[n + 1].bone) * voxel_mm3 << " mm3 of bone\n";
    for (const Structure& structure : task.structures) out << "  protected: '" << structure.name << "'\n";
    describeRules(task, out);
}

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
    return printed("p50 %g us, p99 %g us", times.p50, times.p99);
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
void describePlace(const LoadedScene& loaded, const SceneSetup& simulation, std::ostream& out) {
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

void describeTools(const SceneSetup& simulation, std::ostream& out) {
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

void describeBudget(const SceneSetup& simulation, std::ostream& out) {
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
    SceneSetup simulation = setUpScene(loaded);
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
