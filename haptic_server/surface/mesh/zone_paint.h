// Colours the zones of a task on the bone: vertices show what was taken away there, or what still shall be.
#pragma once

#include <array>
#include <memory>

#include "haptic_server/core/volume/voxel_ids.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/surface/mesh/vertex_paint.h"

namespace bonemill {

struct ZonePaint final : VertexPaint {
    std::shared_ptr<const VoxelIds> zones;
    const VoxelVolume* scanned = nullptr;  // never changes; outlives this
    // By zone, the number that a vertex gets; 0: none.
    std::array<uint8_t, 256> when_gone{};  // where a voxel of it was bone and is gone
    std::array<uint8_t, 256> when_left{};  // else, where bone of it is left

    uint8_t between(const Eigen::Vector3i& bone, const Eigen::Vector3i& air) const noexcept override {
        const bool is_in = (air.array() >= 0).all() && (air.array() < scanned->dims().array()).all();
        const bool is_gone = is_in && scanned->at(air.x(), air.y(), air.z()) >= scanned->iso();
        if (const uint8_t gone = is_gone ? when_gone[zones->at(air)] : uint8_t(0)) return gone;
        return when_left[zones->at(bone)];
    }
    bool mayPaint(const IndexBox& voxels) const noexcept override {
        bool may = false;
        forEachIndex(voxels.clamped(Eigen::Vector3i::Zero(), zones->dims().array() - 1),
                     [&](const Eigen::Vector3i& v) {
                         const uint8_t zone = zones->at(v);
                         may |= when_gone[zone] != 0 || when_left[zone] != 0;
                     });
        return may;
    }
};

}  // namespace bonemill
