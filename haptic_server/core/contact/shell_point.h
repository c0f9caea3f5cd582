// This says where one contact point lies and how the bone faces there. RT-safe; it reads plainly, so tick
// thread only.
//
// The surface is the trilinear iso-surface: in each cell the density interpolated from the eight corners. The
// point is the area centroid of its block's patches, moved onto that surface by Newton steps along the metric
// gradient. Steps that leave the block or find no way are given up for the nearest patch of the block, whose
// cell surely holds surface: there the point is bracketed on the way from the patch's centroid to a corner on
// the other side.
#pragma once

#include <cstdint>

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/contact/patch_id.h"

namespace bonemill {

enum class ShellNormals : uint8_t {
    kTrilinear,          // gradient of the trilinear density at the point
    kCentralDifference,  // central differences at the cell's corners, interpolated trilinearly: smoother
};

struct ShellPoint {
    Eigen::Vector3f position;  // V, m
    Eigen::Vector3f normal;    // V, unit, out of the bone; zero where the density has no gradient
    float area;                // m² of iso-surface that the point stands for, > 0
    BlockKey key;              // of the point's block in the leaf
};

// The projection is accurate when the density is within this part of the largest |density - iso| at the
// cell's corners.
inline constexpr float kProjectionTolerance = 1.0f / 4096;
inline constexpr int kNewtonSteps = 6;  // smooth bone needs one to three

struct SurfacePlace {
    Eigen::Vector3i cell;
    Eigen::Vector3f at;  // cell steps from the cell's first corner, each 0 .. 1
};

class ShellProjection {
  public:
    explicit ShellProjection(const VoxelVolume& volume) noexcept;

    // Walks from `start` (cell steps from the first corner of `block`, inside it) onto the surface without
    // leaving the block. False means that this had no success.
    bool walk(const VoxelVolume& volume, const IndexBox& block, const Eigen::Vector3f& start,
              SurfacePlace& place) const noexcept;

    // Starts from a point inside a cell that has corners on both sides, and always ends on the surface in
    // that cell.
    SurfacePlace bracket(const VoxelVolume& volume, const SurfacePlace& start) const noexcept;

    Eigen::Vector3f position(const SurfacePlace& place) const noexcept {
        return (place.cell.cast<float>() + place.at).cwiseProduct(spacing_);
    }
    Eigen::Vector3f normal(const VoxelVolume& volume, const SurfacePlace& place,
                           ShellNormals kind) const noexcept;
    const Eigen::Vector3f& spacing() const noexcept { return spacing_; }
    const Eigen::Vector3f& inverseSpacing() const noexcept { return inverse_spacing_; }
    // This is (unit / spacing)² per axis, with the largest spacing as unit; it makes a slope a way in
    // equal units.
    const Eigen::Vector3f& steepness() const noexcept { return steepness_; }

  private:
    Eigen::Vector3f spacing_;          // m
    Eigen::Vector3f inverse_spacing_;  // 1/m
    Eigen::Vector3f steepness_;
};

}  // namespace bonemill
