// The scanned bone was made of this, voxel by voxel: the density that it had (how hard it is) and its
// material. What is left of a voxel is the volume's; these never change. Memory goes to bricks that hold bone
// or a material.
#pragma once

#include <algorithm>

#include "haptic_server/core/volume/brick_map.h"
#include "haptic_server/core/volume/material_properties.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

class BoneProperties {
  public:
    // The properties are those of the volume as it is now. material(voxel) is asked for once per voxel, and
    // so is density(voxel), which is iso or more where the volume's is. Allocates; start-up only.
    template <class MaterialOf, class DensityOf>
    BoneProperties(const VoxelVolume& scanned, MaterialOf&& material, DensityOf&& density)
        : map_(scanned.dims()) {
        std::vector<Density> densities(BrickMap::kBrick);
        std::vector<MaterialId> materials(BrickMap::kBrick);
        forEachIndex({Eigen::Vector3i::Zero(), map_.bricksPerAxis().array() - 1},
                     [&](const Eigen::Vector3i& brick) {
                         bool is_something = false;
                         std::fill(densities.begin(), densities.end(), Density(0));
                         std::fill(materials.begin(), materials.end(), kNoMaterial);
                         forEachIndex(map_.voxelsOf(brick), [&](const Eigen::Vector3i& v) {
                             const size_t at = BrickMap::inBrick(v);
                             densities[at] = density(v);
                             materials[at] = material(v);
                             is_something |= densities[at] >= scanned.iso() || materials[at] != kNoMaterial;
                         });
                         if (!is_something) return;
                         map_.addBrick(brick);
                         density_.insert(density_.end(), densities.begin(), densities.end());
                         material_.insert(material_.end(), materials.begin(), materials.end());
                     });
    }
    template <class MaterialOf>
    BoneProperties(const VoxelVolume& scanned, MaterialOf&& material)
        : BoneProperties(scanned, material,
                         [&](const Eigen::Vector3i& v) { return scanned.at(v.x(), v.y(), v.z()); }) {}

    // It is RT-safe, for any thread. Outside it is 0 and kNoMaterial.
    Density original(const Eigen::Vector3i& voxel) const noexcept {
        const size_t at = map_.find(voxel);
        return at == BrickMap::kNowhere ? Density(0) : density_[at];
    }
    MaterialId material(const Eigen::Vector3i& voxel) const noexcept {
        const size_t at = map_.find(voxel);
        return at == BrickMap::kNowhere ? kNoMaterial : material_[at];
    }
    const Eigen::Vector3i& dims() const noexcept { return map_.dims(); }

    // visit(density it had, material) for each corner of a cell that was bone or is of a material.
    template <class Visit>
    void forEachCorner(const Eigen::Vector3i& cell, Visit&& visit) const noexcept {
        map_.forEachCorner(cell, [&](size_t place) { visit(density_[place], material_[place]); });
    }

    // Those who keep something of their own per voxel find its place among placeCount() here,
    // or BrickMap::kNowhere.
    size_t placeOf(const Eigen::Vector3i& voxel) const noexcept { return map_.find(voxel); }
    size_t placeCount() const noexcept { return map_.placeCount(); }
    Density originalAt(size_t place) const noexcept { return density_[place]; }
    MaterialId materialAt(size_t place) const noexcept { return material_[place]; }

  private:
    BrickMap map_;
    std::vector<Density> density_;
    std::vector<MaterialId> material_;
};

}  // namespace bonemill
