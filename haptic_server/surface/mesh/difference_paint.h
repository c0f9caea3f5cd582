// Colours where two bones of one scan differ in what was removed: the surface is that of the one which is
// meshed, and vertices show whether it, the other one or both lost bone there.
#pragma once

#include <memory>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/surface/mesh/vertex_paint.h"

namespace bonemill {

class DifferencePaint final : public VertexPaint {
  public:
    // The three numbers that follow each other: removed from the meshed bone alone, from the other alone,
    // from both.
    enum Part : uint8_t { kHere, kThere, kBoth, kParts };

    // The other bone has the lattice of the meshed one, and may change meanwhile as that may. `first` is the
    // number of kHere. `scanned` never changes; it and `here` outlive this object.
    DifferencePaint(const VoxelVolume& scanned, const VoxelVolume& here,
                    std::shared_ptr<const BoneModel> there, uint8_t first)
        : scanned_(scanned), here_(here), there_(std::move(there)), first_(first) {}

    // On the wall of a cavity the other one may have gone on: bone under the surface that is gone there shows
    // that before all else.
    uint8_t between(const Eigen::Vector3i& bone, const Eigen::Vector3i& air) const noexcept override {
        if (isGone(there_->volume, bone)) return number(kThere);
        if (!wasBone(air)) return 0;
        return number(isGone(there_->volume, air) ? kBoth : kHere);
    }
    bool mayPaint(const IndexBox& voxels) const noexcept override {
        bool may = false;
        forEachIndex(
            voxels.clamped(Eigen::Vector3i::Zero(), scanned_.dims().array() - 1),
            [&](const Eigen::Vector3i& v) { may = may || isGone(there_->volume, v) || isGone(here_, v); });
        return may;
    }
    uint32_t version(LeafId leaf) const noexcept override { return there_->lattice.version(leaf); }

  private:
    uint8_t number(Part part) const noexcept { return uint8_t(first_ + part); }
    bool wasBone(const Eigen::Vector3i& v) const noexcept {
        const bool is_in = (v.array() >= 0).all() && (v.array() < scanned_.dims().array()).all();
        return is_in && scanned_.at(v.x(), v.y(), v.z()) >= scanned_.iso();
    }
    bool isGone(const VoxelVolume& now, const Eigen::Vector3i& v) const noexcept {
        return wasBone(v) && now.at(v.x(), v.y(), v.z()) < now.iso();
    }

    const VoxelVolume& scanned_;
    const VoxelVolume& here_;
    std::shared_ptr<const BoneModel> there_;
    uint8_t first_;
};

}  // namespace bonemill
