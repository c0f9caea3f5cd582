// Makes small valid node meshes and messages for tests of the topics.
#pragma once

#include "common/geometry/node_mesh.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Makes a strip of triangles whose shape depends on leaf and revision.
inline NodeMesh syntheticNode(uint32_t leaf, uint32_t revision, uint32_t triangles = 20) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    mesh.revision = revision;
    mesh.origin = Eigen::Vector3f(static_cast<float>(leaf), 0, 0) * 1e-3f;
    mesh.step = Eigen::Vector3f::Constant(1e-6f);
    for (uint32_t i = 0; i < triangles + 2; ++i) {
        mesh.vertices.push_back({static_cast<uint16_t>(i * 100), static_cast<uint16_t>((i % 2) * 50),
                                 static_cast<uint16_t>((leaf * 31 + revision * 7 + i * i) % 1000), 127, 0});
    }
    for (uint32_t i = 0; i < triangles; ++i) {
        mesh.indices.insert(mesh.indices.end(), {i, i + 1 + i % 2, i + 2 - i % 2});
    }
    return mesh;
}

inline NodeMesh emptyNode(uint32_t leaf, uint32_t revision) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    mesh.revision = revision;
    return mesh;
}

inline topics::SceneInfo syntheticSceneInfo() {
    topics::SceneInfo info;
    info.set_epoch(1);
    info.set_name("synthetic");
    for (const double value : {0.1, 0.2, 0.3}) info.add_p_wv_m(value);
    for (const double value : {1.0, 0.0, 0.0, 0.0}) info.add_q_wv(value);
    for (int axis = 0; axis < 3; ++axis) {
        info.add_bone_min_m(0);
        info.add_bone_max_m(0.02);
    }
    info.set_burr_radius_m(1e-3);
    for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
        info.mutable_tool()->add_vertices_m(value);
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f})
        info.mutable_tool()->add_normals(value);
    for (const uint32_t index : {0, 1, 2}) info.mutable_tool()->add_indices(index);
    return info;
}

inline TickRecord syntheticTick(uint64_t tick) {
    TickRecord record{};
    record.tick = tick;
    record.p_WT[0] = static_cast<double>(tick) * 1e-6;
    record.q_WT[0] = record.q_WT_device[0] = 1;
    return record;
}

}  // namespace bonemill
