// The golden pictures show this: a block with a milled cavity, a closed hollow and an overhang, and a tool in
// the cavity.
#pragma once

#include "haptic_server/surface/mesh/zone_paint.h"
#include "render_client/look/render_scene/render_scene.h"
#include "tests/gl/synthetic_scene.h"

namespace bonemill::test {

inline const Eigen::Vector3d kBlockCenter(0.008, 0.008, 0.008);  // W = V, m
inline constexpr double kBlockRadius = 0.0055;
inline const Eigen::Vector3d kCavityCenter = kBlockCenter + Eigen::Vector3d(0.0012, -0.0045, 0.0008);
inline constexpr double kCavityRadius = 0.0022;
inline const Eigen::Vector3d kHollowCenter = kBlockCenter + Eigen::Vector3d(-0.0016, 0.0004, 0);
inline constexpr double kHollowRadius = 0.0015;
inline constexpr double kBurrRadius = 0.0009;

inline double milledBlockDistance(const Eigen::Vector3d& p) {
    const double outside = (p - kBlockCenter).norm() - kBlockRadius;
    const double cavity = kCavityRadius - (p - kCavityCenter).norm();
    const double hollow = kHollowRadius - (p - kHollowCenter).norm();
    return std::max({outside, cavity, hollow});
}

inline const std::vector<NodeMesh>& milledBlock() {
    static const std::vector<NodeMesh> nodes = meshBody(65, 2.5e-4, milledBlockDistance);
    return nodes;
}

// There is a shell of one material around a core of another, and a lump without one on the right.
inline uint8_t blockMaterial(const Eigen::Vector3d& p) {
    if (p.x() > kBlockCenter.x() + 0.0035) return 0;
    return (p - kBlockCenter).norm() > kBlockRadius - 0.0011 ? 1 : 2;
}

inline const std::vector<NodeMesh>& layeredBlock() {
    static const std::vector<NodeMesh> nodes = meshBody(65, 2.5e-4, milledBlockDistance, blockMaterial);
    return nodes;
}

inline const VoxelVolume& scannedBlock() {
    static const VoxelVolume scanned = bodyVolumeOf(
        65, 2.5e-4, [](const Eigen::Vector3d& p) { return (p - kBlockCenter).norm() - kBlockRadius; });
    return scanned;
}

// The same, and vertices say where it was milled.
inline const std::vector<NodeMesh>& freshBlock(bool has_layers) {
    const auto make = [](const MaterialFunction& material) {
        return meshBody(65, 2.5e-4, milledBlockDistance, material, nullptr, &scannedBlock());
    };
    static const std::vector<NodeMesh> plain = make({}), layered = make(blockMaterial);
    return has_layers ? layered : plain;
}

// A task asked for a cavity that is deeper and narrower: what was to go and is left, and what is gone beyond
// it.
inline const std::vector<NodeMesh>& zonedBlock() {
    static const std::vector<NodeMesh> nodes = [] {
        const VoxelVolume& scanned = scannedBlock();
        std::vector<uint8_t> zones;
        forEachIndex({Eigen::Vector3i::Zero(), scanned.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
            const Eigen::Vector3d p = 2.5e-4 * v.cast<double>() - kCavityCenter;
            const double off_axis = std::hypot(p.x(), p.z());
            zones.push_back(off_axis < 0.0013 ? 1 : off_axis < 0.0018 ? 2 : 3);
        });
        ZonePaint paint;
        paint.zones = std::make_shared<const VoxelIds>(scanned.dims(), zones);
        paint.scanned = &scanned;
        paint.when_left[1] = 1;
        paint.when_gone[2] = 2;
        paint.when_gone[3] = 3;
        return meshBody(65, 2.5e-4, milledBlockDistance, {}, &paint);
    }();
    return nodes;
}

inline void addLayers(topics::SceneInfo& info) {
    const auto add = [&](const char* name, double red, double green, double blue) {
        scene::Material& material = *info.add_materials();
        material.set_name(name);
        material.mutable_color()->set_red(red);
        material.mutable_color()->set_green(green);
        material.mutable_color()->set_blue(blue);
    };
    add("enamel", 0.93, 0.95, 0.98);
    add("dentine", 0.92, 0.72, 0.38);
}

inline topics::SceneInfo milledInfo() {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(kBlockRadius);
    topics::SceneInfo info = makeSceneInfo("milled block", kBlockCenter - half, kBlockCenter + half);
    *info.mutable_tool() = makeToolMesh(kBurrRadius, 4e-4, 0.014);
    info.set_burr_radius_m(kBurrRadius);
    info.mutable_camera()->set_azimuth_rad(0.45);
    info.mutable_camera()->set_elevation_rad(0.35);
    return info;
}

// The burr is in the cavity, its shaft goes out to the front (-y), to the right and up.
inline Pose toolInCavity() {
    Pose X_WT;
    X_WT.position = kCavityCenter + Eigen::Vector3d(0, -0.0004, 0);
    X_WT.rotation = rotationBetween(Eigen::Vector3d::UnitY(), Eigen::Vector3d(0.55, -0.75, 0.35));
    return X_WT;
}

inline void showMilledBlock(RenderScene& scene) {
    scene.setSceneInfo(milledInfo());
    for (const NodeMesh& node : milledBlock()) scene.setNode(node);
    scene.setToolState(makeToolState(toolInCavity(), toolInCavity(), 1));
    scene.setConnection(Connection::kLive);
}

inline topics::Viewer makeWatcher(const std::string& name, topics::Viewer::Role role, double frame_rate_hz) {
    topics::Viewer viewer;
    viewer.set_name(name);
    viewer.set_role(role);
    viewer.set_frame_rate_hz(frame_rate_hz);
    viewer.set_is_complete(true);
    return viewer;
}

// Every figure that effects can send is there, and nothing is damaged.
inline topics::ToolState toolWithEveryEffect(uint32_t events) {
    topics::ToolState tool = makeToolState(toolInCavity(), toolInCavity(), 1);
    topics::EffectState& effects = *tool.mutable_effects();
    effects.set_events(events);
    effects.set_spin_speed(2000);
    effects.set_axis_torque_nm(2.9e-3);
    effects.set_cutting_power_w(5.8);
    effects.set_temperature_c(48.1);
    effects.set_necrotic_mm3(0.12);
    effects.set_protected_id(1);
    effects.set_event_id(1);
    effects.set_protected_distance_m(0.8e-3);
    effects.set_damaged_mm3(0);
    return tool;
}

}  // namespace bonemill::test
