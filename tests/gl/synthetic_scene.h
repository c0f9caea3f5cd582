// Makes a bone of analytic shape and a tool, as the messages that a server would send.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "proto/topics.pb.h"

namespace bonemill::test {

using DistanceFunction = std::function<double(const Eigen::Vector3d& p_V)>;   // m, negative inside
using MaterialFunction = std::function<uint8_t(const Eigen::Vector3d& p_V)>;  // 1 + index in the scene's list

// The densities of a body in a cube of `voxels` per side.
inline VoxelVolume bodyVolumeOf(int voxels, double spacing, const DistanceFunction& distance) {
    VolumeGeometry geometry;
    geometry.dims.setConstant(voxels);
    geometry.spacing.setConstant(spacing);
    constexpr Density kIso = 32768;
    VoxelVolume volume(geometry, kIso);
    for (int k = 0; k < voxels; ++k)
        for (int j = 0; j < voxels; ++j)
            for (int i = 0; i < voxels; ++i) {
                const double steps = distance(spacing * Eigen::Vector3d(i, j, k)) / spacing;
                volume.set(i, j, k, Density(std::lround(kIso - std::clamp(steps / 2, -1.0, 0.99) * 32767)));
            }
    return volume;
}

// Makes the iso-surface of distance = 0, cut into leaves of 16 cells.
inline std::vector<NodeMesh> meshBody(int voxels, double spacing, const DistanceFunction& distance,
                                      const MaterialFunction& material = {},
                                      const VertexPaint* paint = nullptr,
                                      const VoxelVolume* scanned = nullptr) {
    const VoxelVolume volume = bodyVolumeOf(voxels, spacing, distance);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
    std::optional<BoneProperties> properties;
    if (material)
        properties.emplace(volume,
                           [&](const Eigen::Vector3i& v) { return material(spacing * v.cast<double>()); });
    LeafMesher mesher(volume, lattice, MeshGrid::kMaxStepsPerCell,
                      {properties ? &*properties : nullptr, nullptr, scanned});
    mesher.setPaint(paint);
    std::vector<NodeMesh> nodes;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        NodeMesh mesh = mesher.mesh(leaf).value();
        if (!mesh.isEmpty()) nodes.push_back(std::move(mesh));
    }
    return nodes;
}

// It removes the leaf.
inline NodeMesh emptyNode(uint32_t leaf) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    return mesh;
}

inline void setVector(const Eigen::Vector3d& v, google::protobuf::RepeatedField<double>* field) {
    field->Assign(v.data(), v.data() + 3);
}

inline void setQuaternion(const Eigen::Quaterniond& q, google::protobuf::RepeatedField<double>* field) {
    const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
    field->Assign(wxyz, wxyz + 4);
}

// Makes a sphere at T's origin and a shaft along +y, as one surface of revolution.
inline topics::TriangleMesh makeToolMesh(double burr_radius, double shaft_radius, double length) {
    struct Ring {
        double y, radius, normal_y, normal_radial;
    };
    std::vector<Ring> profile;
    const double neck = std::asin(shaft_radius / burr_radius);
    for (int i = 0; i <= 40; ++i) {
        const double angle = M_PI - (M_PI - neck) * i / 40.0;  // from the pole to the neck
        profile.push_back(
            {burr_radius * std::cos(angle), burr_radius * std::sin(angle), std::cos(angle), std::sin(angle)});
    }
    const double start = burr_radius * std::cos(neck);
    const double grip_radius = 2.2 * shaft_radius;
    for (const Ring& ring :
         {Ring{start, shaft_radius, 0, 1}, Ring{length * 0.5, shaft_radius, 0, 1},
          Ring{length * 0.5, shaft_radius, -0.7, 0.7}, Ring{length * 0.56, grip_radius, -0.7, 0.7},
          Ring{length * 0.56, grip_radius, 0, 1}, Ring{length, grip_radius, 0, 1},
          Ring{length, grip_radius, 1, 0}, Ring{length, 0, 1, 0}}) {
        profile.push_back(ring);
    }
    constexpr int kSides = 64;
    topics::TriangleMesh mesh;
    for (const Ring& ring : profile)
        for (int s = 0; s <= kSides; ++s) {
            const double c = std::cos(2 * M_PI * s / kSides), n = std::sin(2 * M_PI * s / kSides);
            for (const double v : {ring.radius * c, ring.y, ring.radius * n}) mesh.add_vertices_m(float(v));
            for (const double v : {ring.normal_radial * c, ring.normal_y, ring.normal_radial * n})
                mesh.add_normals(float(v));
        }
    for (uint32_t r = 0; r + 1 < profile.size(); ++r)
        for (uint32_t s = 0; s < kSides; ++s) {
            const uint32_t a = r * (kSides + 1) + s, b = a + kSides + 1;
            for (const uint32_t i : {a, b, a + 1, a + 1, b, b + 1}) mesh.add_indices(i);
        }
    return mesh;
}

inline topics::SceneInfo makeSceneInfo(const std::string& name, const Eigen::Vector3d& low,
                                       const Eigen::Vector3d& high) {
    topics::SceneInfo info;
    info.set_epoch(1);
    info.set_name(name);
    setVector(Eigen::Vector3d::Zero(), info.mutable_p_wv_m());
    setQuaternion(Eigen::Quaterniond::Identity(), info.mutable_q_wv());
    setVector(low, info.mutable_bone_min_m());
    setVector(high, info.mutable_bone_max_m());
    return info;
}

inline topics::ToolState makeToolState(const Pose& X_WT, const Pose& X_WT_device, uint32_t buttons) {
    topics::ToolState tool;
    setVector(X_WT.position, tool.mutable_p_wt_m());
    setQuaternion(X_WT.rotation, tool.mutable_q_wt());
    setVector(X_WT_device.position, tool.mutable_p_wt_device_m());
    setQuaternion(X_WT_device.rotation, tool.mutable_q_wt_device());
    setVector({0.4, -1.1, 2.9}, tool.mutable_force_n());
    setVector({0.004, -0.011, 0.002}, tool.mutable_torque_nm());
    tool.set_contacts(146);
    tool.set_buttons(buttons);
    return tool;
}

inline void listAllEffects(topics::SceneInfo& info) {
    scene::Effects& effects = *info.mutable_viewer_effects();
    effects.mutable_bone_dust();
    effects.mutable_bleeding()->set_delay_s(0);
    effects.mutable_irrigation()->mutable_nozzle_mm()->set_y(7);
    effects.mutable_burr_spin();
    effects.mutable_milling_sound();
    effects.mutable_browning();
    effects.mutable_bruising();
}

inline topics::Status makeStatus() {
    topics::Status status;
    status.set_scene("synthetic");
    status.set_preset("thesis_2012");
    status.set_ticks(1000);
    status.set_rate_hz(999.8);
    status.set_tick_p99_us(187.4);
    status.set_removed_mm3(12.34);
    status.set_node_count(120);
    return status;
}

}  // namespace bonemill::test
