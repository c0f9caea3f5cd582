#include "haptic_server/scene/setup/scene_setup.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_tools.h"
#include "haptic_server/core/tick/hand_side.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "haptic_server/laws/all_laws.h"
#include "haptic_server/scene/setup/scanned_bone.h"
#include "haptic_server/scene/setup/scene_shapes.h"
#include "haptic_server/scene/setup/scene_task.h"

namespace bonemill {
namespace {

constexpr int kDefaultLeafCells = 16;
constexpr double kLongestDentalTool = 30e-3;  // m from the burr's centre to the shaft's end
constexpr double kMaxOverload =
    3;  // a shaft of half the burr's radius is common, and leans more than it pokes

// Milling rescans the leaves it touches in the tick, so that leaves must stay small.
constexpr int kMaxLeafCells = 128;
constexpr int kSlowLeafCells = 40;

Eigen::Vector3i leafCellsOf(const scene::Volume& volume, const VolumeGeometry& geometry) {
    if (volume.has_octree_depth()) {
        const Eigen::Vector3i cells = LeafLattice::leafCellsOfDepth(geometry, int(volume.octree_depth()));
        if (cells.maxCoeff() > kMaxLeafCells)
            throw UserError("volume.octree_depth: " + std::to_string(volume.octree_depth()) +
                            " cuts this volume into leaves of " + std::to_string(cells.maxCoeff()) +
                            " cells, more than " + std::to_string(kMaxLeafCells) +
                            "; raise it, or set volume.leaf_voxels instead");
        return cells;
    }
    return Eigen::Vector3i::Constant(volume.has_leaf_voxels() ? int(volume.leaf_voxels())
                                                              : kDefaultLeafCells);
}

std::string textOf(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

void warnOfLargeLeaves(SceneSetup& simulation) {
    const int cells = simulation.bone->lattice.leafCells().maxCoeff();
    if (cells > kSlowLeafCells)
        simulation.warnings.push_back(
            "octree leaves of " + std::to_string(cells) +
            " cells make milling ticks long; raise volume.octree_depth or use volume.leaf_voxels");
}

// Says which tool is meant, if there are several.
std::string ofTool(const SceneSetup& simulation, const SceneTool& tool) {
    return simulation.tools.size() > 1 ? tool.name + ": " : "";
}

void warnOfCoarseShell(SceneSetup& simulation, const SceneTool& tool) {
    const AccuracySettings& settings = simulation.accuracy;
    if (settings.tool_distance == ToolDistance::kAnalytic && tool.built.model.hasShapes()) return;
    const double shell_spacing = settings.shell_factor * simulation.bone->volume.spacing().maxCoeff();
    const double sdf_spacing = tool.built.model.grid().spacing();
    if (shell_spacing <= sdf_spacing * (1 + 1e-9)) return;
    simulation.warnings.push_back(
        ofTool(simulation, tool) + "point-shell spacing " + textOf(shell_spacing / kMillimetre) +
        " mm is coarser than the tool's distance grid (" + textOf(sdf_spacing / kMillimetre) +
        " mm): contact can miss thin features; lower accuracy.shell_factor");
}

// The coupling's pull is limited by what the burr carries.
void warnOfThinTool(SceneSetup& simulation, const scene::Scene& scene, const SceneTool& tool) {
    const GradientConfig& config = simulation.tick.gradient;
    double radius = tool.built.model.field(simulation.accuracy).thinnestRadius();
    if (tool.burr.kind == BurrKind::kCone) radius = std::min(radius, tool.burr.tip_radius);
    if (simulation.accuracy.law != ContactLaw::kGradient || radius >= tool.burr.radius) return;
    const double wall = thinnestWall(scene, simulation.bone->volume.spacing().minCoeff());
    const double carried = wallForce(config.contact, radius, wall);
    if (tool.saturation_force <= kMaxOverload * carried) return;
    simulation.warnings.push_back(ofTool(simulation, tool) + "the tool's thinnest part has a radius of " +
                                  textOf(radius / kMillimetre) + " mm: its tip goes through a wall of " +
                                  textOf(wall / kMillimetre) + " mm at " + textOf(carried) +
                                  " N, and the coupling pulls with up to " + textOf(tool.saturation_force) +
                                  " N; lower coupling.max_force_n or contact.thinnest_wall_mm");
}

// In m²: what a burr has in the bone when it is half in, a cylinder or cone with all of its far end.
double areaHalfIn(const Burr& burr) {
    if (burr.kind == BurrKind::kBall) return 2 * M_PI * burr.radius * burr.radius;
    const double end = burr.kind == BurrKind::kCone ? burr.tip_radius : burr.radius;
    return M_PI * (burr.radius + end) * burr.length / 2 + M_PI * end * end;
}

// A tick in which the solve takes long tests each contact point so often (drills of 5 mm:
// docs/howto/realtime.md).
constexpr double kTestsOfPoint = 13;

void warnOfManyPoints(SceneSetup& simulation, const SceneTool& tool) {
    const AccuracySettings& settings = simulation.accuracy;
    if (settings.law != ContactLaw::kGradient) return;
    const double voxel = std::cbrt(simulation.bone->volume.spacing().prod());
    const double points = areaHalfIn(tool.burr) / std::pow(settings.shell_factor * voxel, 2);
    const double affordable = double(simulation.tick.gradient.most_point_tests) /
                              tool.built.model.field(settings).testCost() / kTestsOfPoint;
    if (points <= affordable) return;
    simulation.warnings.push_back(ofTool(simulation, tool) + "half in bone the burr touches some " +
                                  textOf(std::round(points)) + " contact points, and a tick has time for " +
                                  textOf(std::round(affordable)) +
                                  ": coarser ones will be felt (coarser_shell); use voxels of " +
                                  textOf(std::ceil(1e5 * voxel * std::sqrt(points / affordable)) / 100) +
                                  " mm, a smaller burr or a slower loop");
}

// A groove half as deep as the burr's radius R is larger than what was swept by this times (voxel / R)², as
// docs/reference/effects.md (time_removal) has it measured.
constexpr double kGrooveExcess = 1.3;
constexpr double kMaxGrooveExcess = 0.1;

void warnOfCoarseVoxels(SceneSetup& simulation, const SceneTool& tool) {
    const bool is_by_ramp = simulation.accuracy.law == ContactLaw::kGradient;
    if (!simulation.tick.effects.time_removal || !is_by_ramp) return;
    const double voxel = std::sqrt(simulation.bone->volume.spacing().squaredNorm() / 3);
    const double radius = tool.burr.radius;
    const double excess = kGrooveExcess * std::pow(voxel / radius, 2);
    if (excess <= kMaxGrooveExcess) return;
    const double fine_voxel = radius * std::sqrt(kMaxGrooveExcess / kGrooveExcess);
    simulation.warnings.push_back(
        ofTool(simulation, tool) + "voxels of " + textOf(std::round(voxel * 1e5) / 100) +
        " mm are coarse for a burr of " + textOf(radius / kMillimetre) +
        " mm radius: time_removal makes a groove half as deep as that larger by some " +
        textOf(std::round(100 * excess)) + " %; with voxels of at most " +
        textOf(std::floor(fine_voxel * 1e5) / 100) + " mm it is less than 10 %");
}

void warnOfNoBone(SceneSetup& simulation) {
    if (simulation.tick.effects.add_material) return;
    const BoneModel& bone = *simulation.bone;
    for (uint32_t leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        if (bone.lattice.range(0, leaf).max >= bone.volume.iso()) return;
    simulation.warnings.push_back(
        "the volume has no bone: none of its values reaches volume.iso_value; "
        "leave it out to have one proposed");
}

void warnOfColdRemoval(SceneSetup& simulation) {
    const EffectConfigs& effects = simulation.tick.effects;
    if (!effects.thermal || !effects.time_removal) return;
    simulation.warnings.push_back(
        "time_removal makes no heat of what it removes, so that thermal warms bone by "
        "rubbing alone; use energy_removal where heat is judged");
}

// A tick has time for some bricks of cubes only (docs/reference/effects.md, thermal).
constexpr double kFinestHeat = 0.35e-3;  // m

void warnOfFineHeat(SceneSetup& simulation) {
    const auto& thermal = simulation.tick.effects.thermal;
    if (!thermal || thermal->heat.cell >= kFinestHeat) return;
    simulation.warnings.push_back(
        "effects.thermal.cell_mm of " + textOf(thermal->heat.cell / kMillimetre) +
        " is too fine for a hot region wider than some 8 mm, which stays too hot then; "
        "use " +
        textOf(kFinestHeat / kMillimetre) + " or more");
}

// The tools lack what needs the volume.
std::vector<SceneTool> buildTools(const LoadedScene& loaded) {
    const std::vector<std::string> names = toolNamesOf(loaded.scene);
    std::vector<SceneTool> tools;
    for (const scene::Tool* tool : toolsOf(loaded.scene)) {
        const ToolConfig config = toolConfigOf(loaded, *tool);
        const TriangleSurface surface = toolSurface(config);
        tools.push_back({.name = names[tools.size()],
                         .built = buildTool(config, sdfRefinementsOf(loaded.scene, *tool)),
                         .surface = surface,
                         .burr = burrOf(*tool),
                         .saturation_force = 0,
                         .handpiece = handpieceOf(*tool, surface)});
    }
    return tools;
}

void fitToolsToBone(SceneSetup& simulation, const scene::Scene& scene) {
    const std::vector<const scene::Tool*> of_scene = toolsOf(scene);
    const double finest_spacing = simulation.bone->volume.spacing().minCoeff();
    for (size_t n = 0; n < of_scene.size(); ++n) {
        SceneTool& tool = simulation.tools[n];
        tool.saturation_force = saturationForceOf(scene, *of_scene[n], finest_spacing);
        for (const std::string& warning : tool.built.warnings)
            simulation.warnings.push_back(ofTool(simulation, tool) + warning);
        warnOfCoarseShell(simulation, tool);
        warnOfManyPoints(simulation, tool);
        warnOfThinTool(simulation, scene, tool);
        warnOfCoarseVoxels(simulation, tool);
    }
}

// A range or label that nothing has is most often a slip.
void warnOfMissingMaterials(SceneSetup& simulation, const scene::Scene& scene,
                            const std::vector<MaterialId>& material_ids) {
    std::vector<bool> is_there(size_t(scene.material_size()) + 1);
    for (const MaterialId id : material_ids) is_there[id] = true;
    for (int n = 0; n < scene.material_size(); ++n)
        if (!is_there[size_t(n) + 1])
            simulation.warnings.push_back("no voxel is of material '" + scene.material(n).name() +
                                          "'; check its range or labels, and what materials after it take");
}

// The effects that ask for it learn what the scanned bone was made of.
void addProperties(SceneSetup& simulation, const LoadedScene& loaded, const ScannedBone& scanned) {
    if (!wantsProperties(loaded.scene)) return;
    const VoxelVolume& volume = scanned.volume;
    const std::vector<MaterialId>& ids = scanned.materials.ids;
    warnOfMissingMaterials(simulation, loaded.scene, ids);
    const auto index = [&dims = volume.dims()](const Eigen::Vector3i& v) {
        return size_t(v.x()) + size_t(dims.x()) * (size_t(v.y()) + size_t(dims.y()) * size_t(v.z()));
    };
    const auto material = [&](const Eigen::Vector3i& v) { return ids.empty() ? kNoMaterial : ids[index(v)]; };
    const auto density = [&](const Eigen::Vector3i& v) {
        const Density own = volume.at(v.x(), v.y(), v.z());
        if (own < volume.iso() || scanned.inner_values.size() == 0) return own;
        return std::max(own, scanned.mapping.density(double(scanned.inner_values[index(v)])));
    };
    EffectConfigs& effects = simulation.tick.effects;
    effects.properties = std::make_shared<const BoneProperties>(volume, material, density);
    effects.protected_field = protectedFieldOf(loaded, *effects.properties, volume.spacing());
}

}  // namespace

std::vector<SpoTool> SceneSetup::spoTools() const {
    std::vector<SpoTool> all;
    for (const SceneTool& tool : tools) all.push_back({&tool.built.model, tool.burr, tool.saturation_force});
    return all;
}

std::optional<BreachMonitor> breachWatchOf(const SceneSetup& simulation) {
    if (!simulation.task || !simulation.task->plan) return std::nullopt;
    std::vector<BurrProbes> burrs;
    for (const SceneTool& tool : simulation.tools) burrs.emplace_back(tool.burr);
    return BreachMonitor(simulation.bone->volume, *simulation.task->plan, std::move(burrs));
}

scene::Tool::Handpiece handpieceOf(const scene::Tool& tool, const TriangleSurface& surface) {
    if (tool.handpiece() != scene::Tool::AUTOMATIC) return tool.handpiece();
    if (!tool.mesh_path().empty()) return scene::Tool::NONE;
    float end = 0;
    for (const Eigen::Vector3f& p : surface.positions) end = std::max(end, p.y());
    return end < kLongestDentalTool ? scene::Tool::CONTRA_ANGLE : scene::Tool::STRAIGHT;
}

TickConfig tickConfigOf(const scene::Scene& scene) {
    TickConfig config;
    config.laws = allLaws();
    config.gradient = gradientConfigOf(scene);
    config.dt = 1 / scene.loop().rate_hz();
    config.contact = {.point_stiffness = scene.contact().point_stiffness_n_per_mm() / kMillimetre,
                      .full_stiffness_contacts = scene.contact().full_stiffness_contacts()};
    const scene::Coupling& coupling = scene.coupling();
    config.coupling = {.translation_stiffness = coupling.translation_stiffness_n_per_mm() / kMillimetre,
                       .rotation_stiffness = coupling.rotation_stiffness_nmm_per_rad() * kMillimetre,
                       .max_speed = coupling.max_speed_mm_per_s() * kMillimetre,
                       .max_angular_speed = coupling.max_angular_speed_deg_per_s() * kDegree,
                       .static_damping = coupling.static_damping()};
    config.hand = {.max_force = coupling.max_force_n(),
                   .max_torque = coupling.max_torque_nmm() * kMillimetre};
    setHandSpace(config, HandSpace(scene.device().workspace_scale()));
    config.effects = effectConfigsOf(scene);
    TickBudget::apply(config.dt, config.gradient, config.most_milled_cells);
    return config;
}

ToolConfig toolConfigOf(const LoadedScene& loaded, const scene::Tool& tool) {
    ToolConfig config;
    for (const scene::Tool::Shape& shape : tool.shape()) config.shapes.push_back(toolShapeOf(shape));
    if (tool.has_mesh_path()) config.mesh_path = resolvePath(loaded, tool.mesh_path());
    const Burr burr = burrOf(tool);
    config.burr_kind = burr.kind;
    config.burr_radius = burr.radius;
    config.burr_length = burr.length;
    config.burr_tip_radius = burr.tip_radius;
    config.sdf_nodes = {int(tool.sdf_nodes_x()), int(tool.sdf_nodes_y()), int(tool.sdf_nodes_z())};
    config.sdf_spacing = tool.sdf_spacing_mm() * kMillimetre;
    if (tool.has_sdf_origin_mm()) config.sdf_origin_T = metresOf(tool.sdf_origin_mm());
    return config;
}

SceneSetup setUpScene(const LoadedScene& loaded) {
    const scene::Scene& scene = loaded.scene;
    SceneSetup simulation{.tick = {},
                          .accuracy = accuracyOf(scene),
                          .bone = nullptr,
                          .mapping = {},
                          .segment_colors = {},
                          .label_edge = 0,
                          .tools = buildTools(loaded),
                          .X_WD = poseOf(scene.device()),
                          .remarks = {},
                          .warnings = {}};
    ScannedBone scanned = readBone(loaded);
    simulation.remarks = std::move(scanned.remarks);
    simulation.warnings = std::move(scanned.warnings);
    simulation.lacks_patient_axes = scanned.lacks_patient_axes;
    simulation.mapping = scanned.mapping;
    simulation.segment_colors = std::move(scanned.materials.segment_colors);
    simulation.label_edge = scanned.materials.label_edge;
    simulation.labelled = std::move(scanned.materials.labelled);
    simulation.surroundings = std::move(scanned.surroundings);
    const Eigen::Vector3i leaf_cells = leafCellsOf(scene.volume(), scanned.volume.geometry());
    simulation.tick = tickConfigOf(scene);
    mapRawValues(simulation.tick.effects, loaded, simulation.mapping);
    addProperties(simulation, loaded, scanned);
    simulation.bone =
        std::make_unique<BoneModel>(std::move(scanned.volume), leaf_cells, shellConfigOf(scene));
    simulation.task = judgedTaskOf(loaded, simulation.bone->volume, simulation.tick.effects.properties);
    warnOfLargeLeaves(simulation);
    warnOfNoBone(simulation);
    warnOfColdRemoval(simulation);
    warnOfFineHeat(simulation);
    fitToolsToBone(simulation, scene);
    simulation.tunable = TunableScene(scene, simulation.bone->volume.spacing().minCoeff());
    return simulation;
}

}  // namespace bonemill
