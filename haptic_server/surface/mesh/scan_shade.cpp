#include "haptic_server/surface/mesh/scan_shade.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

constexpr int kNoBone = 1, kLowest = 2, kHighest = 255;  // of what is remembered
constexpr float kDepth = 1;                              // scan voxels under the surface

}  // namespace

uint8_t ShadeScale::at(float density) const noexcept {
    const float share = (density - float(low)) / float(high - low);
    return uint8_t(first + std::lround(std::clamp(share, 0.0f, 1.0f) * float(count - 1)));
}

ScanShade::ScanShade(const ShadeScale& scale, const VolumeGeometry& scan, const Pose& X_SV, Density iso,
                     DensityAt density_at)
    : scale_(scale),
      dims_(scan.dims),
      spacing_(scan.spacing.cast<float>()),
      R_SV_(X_SV.rotation.toRotationMatrix().cast<float>()),
      p_SV_(X_SV.position.cast<float>()),
      iso_(iso),
      density_at_(std::move(density_at)),
      bricks_((scan.dims.array() + kBrick - 1) / kBrick),
      known_(size_t(bricks_.prod())) {}

// Linear between the voxels around a place a voxel under the surface; those without bone near them have
// no say.
uint8_t ScanShade::under(const Eigen::Vector3f& p_V, const Eigen::Vector3f& normal_V) {
    const Eigen::Vector3f inwards = -(R_SV_ * normal_V).normalized();
    const Eigen::Array3f place = (R_SV_ * p_V + p_SV_).array() / spacing_.array() + kDepth * inwards.array();
    const Eigen::Array3i low = place.floor().cast<int>();
    const Eigen::Array3f fraction = place - low.cast<float>();
    float sum = 0, weights = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Array3i step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        const float smooth = smoothAt(low + step);
        const float weight = (smooth > 0 ? 1.0f : 0.0f) * (step > 0).select(fraction, 1 - fraction).prod();
        sum += weight * smooth;
        weights += weight;
    }
    return weights > 0 ? scale_.at(sum / weights) : scale_.first;
}

uint8_t& ScanShade::knownAt(const Eigen::Vector3i& voxel) {
    const Eigen::Vector3i brick = voxel / kBrick, local = voxel - kBrick * brick;
    std::unique_ptr<Brick>& known =
        known_[size_t(brick.x() + bricks_.x() * (brick.y() + bricks_.y() * brick.z()))];
    if (!known) known = std::make_unique<Brick>();
    return (*known)[size_t(local.x() + kBrick * (local.y() + kBrick * local.z()))];
}

float ScanShade::smoothAt(const Eigen::Vector3i& voxel) {
    if ((voxel.array() < 0).any() || (voxel.array() >= dims_.array()).any()) return 0;
    uint8_t& known = knownAt(voxel);
    const auto span = float(scale_.high - scale_.low);
    if (known == 0) {
        const float density = computedAt(voxel);
        const float share = std::clamp((density - float(scale_.low)) / span, 0.0f, 1.0f);
        known = uint8_t(density > 0 ? kLowest + std::lround(share * (kHighest - kLowest)) : kNoBone);
    }
    return known == kNoBone ? 0
                            : float(scale_.low) + span * float(known - kLowest) / float(kHighest - kLowest);
}

// Mean of the bone around the voxel, the denser the more: beside air the scanner saw a mixture, which is no
// other bone.
float ScanShade::computedAt(const Eigen::Vector3i& voxel) const {
    double sum = 0, weights = 0;
    forEachIndex(IndexBox{voxel, voxel}.grown(1), [&](const Eigen::Vector3i& v) {
        const Density density = density_at_(v);
        if (density < iso_) return;
        const double weight = density * std::sqrt(double(density));
        sum += weight * density;
        weights += weight;
    });
    return weights > 0 ? float(sum / weights) : 0;
}

ScanShade::DensityAt densitiesOf(const VoxelVolume& volume) {
    return [&volume](const Eigen::Vector3i& v) {
        const bool is_inside = (v.array() >= 0).all() && (v.array() < volume.dims().array()).all();
        return is_inside ? volume.at(v.x(), v.y(), v.z()) : Density(0);
    };
}

}  // namespace bonemill
