#include "haptic_server/assessment/product/signed_field.h"

#include "haptic_server/scans/densify/distance_transform.h"

namespace bonemill {

SignedField::SignedField(const IndexBox& box, const Eigen::Vector3d& spacing,
                         const std::function<bool(const Eigen::Vector3i&)>& is_inside)
    : box_(box), size_(box.max - box.min + Eigen::Vector3i::Ones()), spacing_(spacing) {
    distance_.reserve(size_t(box.count()));
    DistanceTransform transform(box, spacing);
    transform.run([&](const Eigen::Vector3i& v) { return MaterialId(is_inside(v) ? 1 : kNoMaterial); });
    forEachIndex(box, [&](const Eigen::Vector3i& v) { distance_.push_back(float(-transform.distance(v))); });
    transform.run([&](const Eigen::Vector3i& v) { return MaterialId(is_inside(v) ? kNoMaterial : 1); });
    size_t at = 0;
    forEachIndex(box, [&](const Eigen::Vector3i& v) {
        const double inwards = transform.distance(v);
        if (inwards > 0) distance_[at] = float(inwards);
        ++at;
    });
}

double SignedField::sample(const Eigen::Vector3i& voxel) const noexcept {
    const Eigen::Vector3i n = voxel.cwiseMax(box_.min).cwiseMin(box_.max) - box_.min;
    return double(
        distance_[size_t(n.x()) + size_t(size_.x()) * (size_t(n.y()) + size_t(size_.y()) * size_t(n.z()))]);
}

double SignedField::at(const Eigen::Vector3d& p_V) const noexcept {
    constexpr double kFar = 1e6;  // voxels: what an int holds
    const Eigen::Array3d place = (p_V.array() / spacing_.array()).max(-kFar).min(kFar);
    const Eigen::Array3d low = place.floor(), t = place - low;
    const Eigen::Vector3i voxel = low.cast<int>();
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2);
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= step[axis] ? t[axis] : 1 - t[axis];
        if (weight > 0) sum += weight * sample(voxel + step);
    }
    return sum;
}

}  // namespace bonemill
