#include "tests/stability/scene.h"

#include <set>

#include "haptic_server/scans/densify/distance_transform.h"
#include "tests/support/milling_config.h"

namespace bonemill::test {
namespace {

FixedTickConfig configOf(const Variant& variant, double dt,
                         const std::function<void(FixedTickConfig&)>& edit) {
    FixedTickConfig config = millingConfig();
    config.dt = dt;
    config.tool.burr.radius = kBurrRadius;
    applyVariant(variant, config);
    if (edit) edit(config);
    return config;
}

// Every second slab of the bone is soft, and protected: edges wherever the tool goes.
constexpr double kSlab = 0.5e-3;  // m
constexpr double kSoft = 0.7;
constexpr MaterialId kSoftBone = 1;

void layOut(FixedTickConfig& config, const BoneModel& bone) {
    EffectConfigs& effects = config.effects;
    const VoxelVolume& volume = bone.volume;
    const int slab = int(std::ceil(kSlab / volume.spacing().x()));
    effects.materials.assign(2, {});
    effects.materials[kSoftBone] = {.stiffness_factor = kSoft, .is_protected = true};
    effects.properties = std::make_shared<const BoneProperties>(volume, [&](const Eigen::Vector3i& v) {
        const bool is_bone = volume.at(v.x(), v.y(), v.z()) >= volume.iso();
        return is_bone && v.x() / slab % 2 == 1 ? kSoftBone : kNoMaterial;
    });
    effects.protected_field = protectedDistance(*effects.properties, effects.materials, volume.spacing(),
                                                config.tool.burr.radius + 1e-3);
    if (!effects.protected_field) effects.virtual_fixture.reset();  // no bone in this scene
    // The tool saturates at what soft bone carries.
    config.tool.saturation_force *= kSoft;
}

ShellConfig shellOf(const AccuracySettings& accuracy, bool every_preset) {
    ShellConfig shell{.levels = {{accuracy.shell_factor}}};
    if (!every_preset) return shell;
    std::set<int> factors{accuracy.shell_factor};
    for (const Preset preset : allPresets())
        if (const int factor = presetSettings(preset).shell_factor; factors.insert(factor).second)
            shell.levels.push_back({factor});
    return shell;
}

}  // namespace

Scene::Scene(VoxelVolume volume, TestTool test_tool, const Variant& variant, double dt,
             const std::function<void(FixedTickConfig&)>& edit, bool every_preset)
    : config(configOf(variant, dt, edit)),
      device(variant.device),
      held_buttons(variant.held_buttons),
      averaged_ticks(config.effects.burr_vibration ? kVibrationTicks : 1),
      bone(std::move(volume), Eigen::Vector3i::Constant(16), shellOf(config.accuracy, every_preset)),
      tool(std::move(test_tool.grid), test_tool.shapes, test_tool.thinnest_radius) {
    if (config.effects.material_stiffness || config.effects.virtual_fixture) layOut(config, bone);
}

VolumeGeometry boxOf(const Eigen::Vector3d& size, double spacing) {
    VolumeGeometry geometry;
    geometry.dims = (size / spacing).array().ceil().cast<int>() + 1;
    geometry.spacing.setConstant(spacing);
    return geometry;
}

SdfGrid gridOf(const DistanceFunction& distance_T, const Eigen::Vector3d& half_size, double spacing) {
    const Eigen::Vector3i half = (half_size / spacing).array().ceil().cast<int>() + 3;
    const Eigen::Vector3i nodes = 2 * half.array() + 1;
    std::vector<float> values;
    for (int k = 0; k < nodes.z(); ++k)
        for (int j = 0; j < nodes.y(); ++j)
            for (int i = 0; i < nodes.x(); ++i)
                values.push_back(
                    float(distance_T(spacing * (Eigen::Vector3i(i, j, k) - half).cast<double>())));
    return SdfGrid(nodes, spacing, -spacing * half.cast<double>(), std::move(values));
}

TestTool burr() {
    return {sphereTool(kBurrRadius, kVoxel), {SphereShape{{0, 0, 0}, kBurrRadius}}, kBurrRadius};
}

TestTool pegTool(double radius, double half_length) {
    const auto capsule = [=](const Eigen::Vector3d& p) {
        const double y = std::clamp(p.y(), -half_length, half_length);
        return (p - Eigen::Vector3d(0, y, 0)).norm() - radius;
    };
    const CapsuleShape shape{{0, -half_length, 0}, {0, half_length, 0}, radius};
    return {gridOf(capsule, {radius, half_length + radius, radius}), {shape}, radius};
}

DistanceFunction holeAlongY(const Eigen::Vector3d& center, double radius) {
    return
        [=](const Eigen::Vector3d& p) { return radius - std::hypot(p.x() - center.x(), p.z() - center.z()); };
}

DistanceFunction wall(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double thickness) {
    return [=](const Eigen::Vector3d& p) { return std::abs(normal.dot(p - point)) - thickness / 2; };
}

DistanceFunction groove(const Eigen::Vector3d& edge, double angle) {
    const double c = std::cos(angle / 2), s = std::sin(angle / 2);
    return [=](const Eigen::Vector3d& p) {
        const Eigen::Vector3d r = p - edge;
        return std::min(s * r.z() - c * r.x(), s * r.z() + c * r.x());
    };
}

}  // namespace bonemill::test
