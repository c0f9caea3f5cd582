#include "haptic_server/lab/accuracy_report/analytic_probe.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/lab/accuracy_report/measures.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/scene/tool_build/build_tool.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kLoads[] = {0.5, 1, 2, 4};                               // N
constexpr double kWidths[] = {1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24};  // voxels
constexpr double kWidestOfRadius = 1.6;  // contact circle's diameter, burr radii
constexpr double kBorderVoxels = 8;      // of the plane's volume around the contact
constexpr double kStartHeight = 0.1e-3;  // m
constexpr int kPressTicks = 100, kRestTicks = 60, kMeanTicks = 20;
constexpr Density kIso = 32768;
constexpr double kProbedRampVoxels = 8;  // over which the density falls from full to none

double depthOfWidth(double radius, double width) {
    return radius - std::sqrt(radius * radius - width * width / 4);
}

ToolModel buildBurr(const AnalyticProbeConfig& config) {
    ToolConfig tool;
    tool.burr_radius = config.tick.tool.burr.radius;
    tool.shapes = {SphereShape{Vector3d::Zero(), tool.burr_radius}};
    tool.sdf_spacing = config.sdf_spacing;
    const int half = int(std::ceil(tool.burr_radius / config.sdf_spacing)) + 3;
    tool.sdf_nodes.setConstant(2 * half + 1);
    tool.sdf_origin_T = Vector3d::Constant(-half * config.sdf_spacing);
    return buildTool(tool, config.refinements).model;
}

// Fills the half-space z_W < 0, where the density is a linear ramp, which trilinear interpolation keeps.
VoxelVolume halfSpace(double half_edge, double spacing, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    VolumeGeometry geometry;
    geometry.spacing.setConstant(spacing);
    geometry.dims.setConstant(2 * int(std::ceil(half_edge / spacing)) + 1);
    Eigen::Vector4d q;
    do {
        q = {uniform(random), uniform(random), uniform(random), uniform(random)};
    } while (q.norm() > 1 || q.norm() < 0.1);
    geometry.X_WV.rotation = Eigen::Quaterniond(q).normalized();
    const Vector3d middle = 0.5 * spacing * (geometry.dims.array() - 1).cast<double>().matrix();
    const Vector3d shift = spacing / 2 * Vector3d(uniform(random), uniform(random), uniform(random));
    geometry.X_WV.position = shift - geometry.X_WV.rotation * middle;
    VoxelVolume volume(geometry, kIso);
    forEachIndex({Eigen::Vector3i::Zero(), geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const double height = (geometry.X_WV * (spacing * v.cast<double>())).z();
        const double density = kIso - height / (kProbedRampVoxels * spacing) * kMaxDensity;
        volume.set(v.x(), v.y(), v.z(), Density(std::lround(std::clamp(density, 0.0, double(kMaxDensity)))));
    });
    return volume;
}

Eigen::Quaterniond randomRotation(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-M_PI, M_PI);
    return expRotation({uniform(random), uniform(random), uniform(random)});
}

// Goes down to `depth` and rests there.
PosePath pressPath(const Eigen::Quaterniond& rotation, double radius, double depth) {
    PosePath path;
    for (int n = 0; n < kPressTicks + kRestTicks; ++n) {
        const double share = std::min(1.0, double(n) / kPressTicks);
        path.push_back({{0, 0, radius + kStartHeight - share * (kStartHeight + depth)}, rotation});
    }
    return path;
}

double springForce(const EnergyCoupling& coupling, double stretch) {
    return coupling.saturation_force *
           std::tanh(coupling.translation_stiffness * stretch / coupling.saturation_force);
}

// Describes the resting burr by means over the last ticks.
struct Rest {
    double force = 0, depth = 0;
};
Rest restOf(const RunRecords& records, double radius) {
    Rest rest;
    for (size_t n = records.size() - kMeanTicks; n < records.size(); ++n) {
        rest.force += Vector3d(records[n].f_hand_W).norm() / kMeanTicks;
        rest.depth += (radius - records[n].p_WT[2]) / kMeanTicks;
    }
    return rest;
}

}  // namespace

double forceOnSphere(double kappa, double radius, double depth) noexcept {
    return depth <= 0 ? 0 : M_PI * kappa * (radius - depth) * depth * depth;
}

double contactWidth(double kappa, double radius, double force) noexcept {
    double low = 0, high = 2 * radius / 3;  // the force rises up to there
    for (int n = 0; n < 100; ++n) {
        const double middle = (low + high) / 2;
        (forceOnSphere(kappa, radius, middle) > force ? high : low) = middle;
    }
    return 2 * std::sqrt(low * (2 * radius - low));
}

double depthUnderSpring(const FixedTickConfig& tick, double device_depth) noexcept {
    const double radius = tick.tool.burr.radius;
    double low = 0, high = std::min(device_depth, 2 * radius / 3);  // the force rises up to there
    for (int n = 0; n < 100; ++n) {
        const double middle = (low + high) / 2;
        const bool is_too_deep = forceOnSphere(tick.gradient.contact.stiffness_per_area, radius, middle) >
                                 springForce(tick.toolCoupling(), device_depth - middle);
        (is_too_deep ? high : low) = middle;
    }
    return (low + high) / 2;
}

AnalyticProbe::AnalyticProbe(const AnalyticProbeConfig& config) : config_(config), burr_(buildBurr(config)) {
    std::mt19937 random(1);
    std::vector<ShellLevel> levels;
    for (const int factor : config.shell_factors) levels.push_back({factor});
    const double radius = config.tick.tool.burr.radius;
    const double widest =
        std::min(kWidestOfRadius * radius, kWidths[std::size(kWidths) - 1] * config.spacing);
    for (int n = 0; n < kGrids; ++n) {
        VoxelVolume volume = halfSpace(widest / 2 + kBorderVoxels * config.spacing, config.spacing, random);
        planes_.push_back({BoneModel(std::move(volume), Eigen::Vector3i::Constant(kLeafCells),
                                     ShellConfig{.levels = levels, .spare_points = 1}),
                           randomRotation(random)});
    }
}

PlaneErrors AnalyticProbe::measure(const AccuracySettings& settings) {
    FixedTickConfig tick = config_.tick;
    tick.tool.model = &burr_;
    tick.accuracy = settings;
    if (!config_.has_analytic_tool) tick.accuracy.tool_distance = ToolDistance::kGrid;
    const double radius = tick.tool.burr.radius;
    PlaneErrors errors;
    int count = 0;
    for (const double load : kLoads) {
        const double most = tick.tool.saturation_force;
        const double pull = std::min(load, kHeaviestShare * most);
        const double true_stretch =
            std::atanh(pull / most) * most / tick.gradient.coupling.translation_stiffness;
        const double true_depth = depthUnderSpring(tick, true_stretch);
        const double true_force = springForce(tick.toolCoupling(), true_stretch - true_depth);
        double low = INFINITY, high = 0, sum = 0;
        for (Plane& plane : planes_) {
            const Rest rest = restOf(
                runPath(tick, plane.bone, inputsOf(pressPath(plane.R_WT, radius, true_stretch), tick.dt)),
                radius);
            errors.force += std::pow(rest.force / true_force - 1, 2);
            errors.depth += std::pow(rest.depth - true_depth, 2);
            low = std::min(low, rest.force), high = std::max(high, rest.force), sum += rest.force;
            ++count;
        }
        if (sum > 0) errors.anisotropy = std::max(errors.anisotropy, (high - low) / (sum / kGrids));
    }
    errors.force = std::sqrt(errors.force / count);
    errors.depth = std::sqrt(errors.depth / count);
    return errors;
}

PatchErrors AnalyticProbe::patchAt(const AccuracySettings& settings, double width_voxels) const {
    const double radius = config_.tick.tool.burr.radius;
    const double kappa = config_.tick.gradient.contact.stiffness_per_area;
    PatchErrors errors{.shell_factor = settings.shell_factor,
                       .tool_distance = settings.tool_distance,
                       .sdf_refinement = settings.sdf_refinement,
                       .sample_spacing = settings.sample_spacing,
                       .width_voxels = width_voxels,
                       .depth = depthOfWidth(radius, width_voxels * config_.spacing)};
    const double true_force = forceOnSphere(kappa, radius, errors.depth);
    GradientContact contact({.stiffness_per_area = kappa, .stiffness_cap = INFINITY});
    const ToolField& field = burr_.field(settings);
    for (const Plane& plane : planes_) {
        const BoneModel& bone = plane.bone;
        const Pose X_WV = bone.volume.geometry().X_WV;
        const Pose X_VT = X_WV.inverse() * Pose{{0, 0, radius - errors.depth}, plane.R_WT};
        contact.gather({bone.volume, bone.lattice, bone.shell, levelOf(bone.shell, settings),
                        settings.sample_spacing, settings.most_samples},
                       field, X_VT, 1e-6);
        const Vector3d force = X_WV.rotation * contact.evaluate<double>(field, X_VT).term.wrench.force;
        const double error = std::abs(force.norm() / true_force - 1);
        errors.force_rms += error * error / kGrids;
        errors.force_worst = std::max(errors.force_worst, error);
        errors.direction_rms += std::pow(std::atan2(force.head<2>().norm(), force.z()), 2) / kGrids;
    }
    errors.force_rms = std::sqrt(errors.force_rms);
    errors.direction_rms = std::sqrt(errors.direction_rms);
    return errors;
}

std::vector<PatchErrors> AnalyticProbe::patchErrors() const {
    AccuracySettings settings;
    settings.most_samples = kUnlimitedSamples;
    std::vector<AccuracySettings> kinds;
    for (const Preset preset : {Preset::kThesis2012, Preset::kFast, Preset::kBalanced, Preset::kExact}) {
        settings.sample_spacing = presetSettings(preset).sample_spacing;
        kinds.push_back(settings);
    }
    settings.tool_distance = ToolDistance::kGrid;
    settings.sdf_refinement = 1;
    kinds.push_back(settings);
    for (const int refinement : config_.refinements) {
        settings.sdf_refinement = refinement;
        kinds.push_back(settings);
    }
    std::vector<PatchErrors> all;
    for (const int factor : config_.shell_factors)
        for (const double width : kWidths) {
            if (width * config_.spacing > kWidestOfRadius * config_.tick.tool.burr.radius) continue;
            for (AccuracySettings kind : kinds) {
                kind.shell_factor = factor;
                all.push_back(patchAt(kind, width));
            }
        }
    return all;
}

}  // namespace bonemill
