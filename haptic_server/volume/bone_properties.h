// What the scanned bone was made of, voxel by voxel: the density that it had (how hard it is) and its
// material. What is left of a voxel is the volume's; these never change. Memory goes to bricks that hold bone
// or a material.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/volume/voxel_volume.h"

namespace bonemill {

using MaterialId = uint8_t;  // 1 + index in the scene's list; 0: none
inline constexpr MaterialId kNoMaterial = 0;

class BoneProperties {
  public:
    // Of the volume as it is now. material(voxel) is asked for once per voxel. Allocates; start-up only.
    template <class MaterialOf>
    BoneProperties(const VoxelVolume& scanned, MaterialOf&& material);

    // RT-safe, any thread. 0 and kNoMaterial outside.
    Density original(const Eigen::Vector3i& voxel) const noexcept {
        const size_t at = find(voxel);
        return at == kNowhere ? Density(0) : density_[at];
    }
    MaterialId material(const Eigen::Vector3i& voxel) const noexcept {
        const size_t at = find(voxel);
        return at == kNowhere ? kNoMaterial : material_[at];
    }
    const Eigen::Vector3i& dims() const noexcept { return dims_; }

  private:
    static constexpr int kShift = 4, kEdge = 1 << kShift;
    static constexpr size_t kNowhere = ~size_t(0), kBrick = size_t(kEdge) * kEdge * kEdge;
    static constexpr uint32_t kNone = ~uint32_t(0);

    size_t find(const Eigen::Vector3i& voxel) const noexcept {
        if ((voxel.array() < 0).any() || (voxel.array() >= dims_.array()).any()) return kNowhere;
        const Eigen::Vector3i brick = voxel.unaryExpr([](int v) { return v >> kShift; });
        const uint32_t slot = slots_[brickIndex(brick)];
        return slot == kNone ? kNowhere : slot * kBrick + inBrick(voxel);
    }
    size_t brickIndex(const Eigen::Vector3i& brick) const noexcept {
        return size_t(brick.x()) +
               size_t(bricks_.x()) * (size_t(brick.y()) + size_t(bricks_.y()) * size_t(brick.z()));
    }
    static size_t inBrick(const Eigen::Vector3i& voxel) noexcept {
        constexpr int kMask = kEdge - 1;
        return size_t(voxel.x() & kMask) +
               size_t(kEdge) * (size_t(voxel.y() & kMask) + size_t(kEdge) * size_t(voxel.z() & kMask));
    }

    Eigen::Vector3i dims_, bricks_;
    std::vector<uint32_t> slots_;  // per brick: where in the pools
    std::vector<Density> density_;
    std::vector<MaterialId> material_;
};

template <class MaterialOf>
BoneProperties::BoneProperties(const VoxelVolume& scanned, MaterialOf&& material)
    : dims_(scanned.dims()),
      bricks_((scanned.dims().array() + kEdge - 1) / kEdge),
      slots_(size_t(bricks_.prod()), kNone) {
    std::vector<Density> density(kBrick);
    std::vector<MaterialId> materials(kBrick);
    forEachIndex({Eigen::Vector3i::Zero(), bricks_.array() - 1}, [&](const Eigen::Vector3i& brick) {
        const Eigen::Vector3i low = brick * kEdge;
        const IndexBox voxels{low, (low.array() + kEdge - 1).min(dims_.array() - 1)};
        bool is_something = false;
        std::fill(density.begin(), density.end(), Density(0));
        std::fill(materials.begin(), materials.end(), kNoMaterial);
        forEachIndex(voxels, [&](const Eigen::Vector3i& v) {
            const size_t at = inBrick(v);
            density[at] = scanned.at(v.x(), v.y(), v.z());
            materials[at] = material(v);
            is_something |= density[at] >= scanned.iso() || materials[at] != kNoMaterial;
        });
        if (!is_something) return;
        slots_[brickIndex(brick)] = uint32_t(density_.size() / kBrick);
        density_.insert(density_.end(), density.begin(), density.end());
        material_.insert(material_.end(), materials.begin(), materials.end());
    });
}

}  // namespace bonemill
