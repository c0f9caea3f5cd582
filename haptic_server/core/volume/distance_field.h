// Says how far it is to the nearest protected structure, and which one that is: there are samples at the
// voxels, trilinear between them. They are known up to `reach`, also outside of the volume; memory goes to
// bricks where it is less.
//
// The frame is V, the unit m; it is negative inside a structure. Reading is RT-safe, for any thread.
#pragma once

#include <algorithm>
#include <cmath>

#include "haptic_server/core/volume/brick_map.h"
#include "haptic_server/core/volume/material_properties.h"

namespace bonemill {

struct DistanceSample {
    double distance;             // m; reach() where it is that far or farther
    Eigen::Vector3d gradient_V;  // of the trilinear distance
    MaterialId nearest;          // kNoMaterial: nothing within reach
};

class DistanceField {
  public:
    // The samples are at the voxels of this box, which may go beyond the volume, and are `reach`
    // everywhere. It allocates.
    DistanceField(const IndexBox& voxels, const Eigen::Vector3d& spacing, double reach)
        : first_(voxels.min),
          spacing_(spacing),
          reach_(reach),
          map_(voxels.max - voxels.min + Eigen::Vector3i::Ones()) {}

    double reach() const noexcept { return reach_; }
    DistanceSample at(const Eigen::Vector3d& p_V) const noexcept;
    // Interpolates by quadratic B-splines, with a gradient that has no jumps. This is exact beside a plane;
    // beside a ball of radius R the distance is h²/4R farther, h a voxel's size.
    DistanceSample smoothAt(const Eigen::Vector3d& p_V) const noexcept;
    size_t bytes() const noexcept { return distance_.size() * (sizeof(float) + sizeof(MaterialId)); }

    // It is for start-up only. Fills bricks of samples, layer after layer along z; sample(voxel) gives
    // {distance, nearest} for the box's voxels.
    int layerCount() const noexcept { return map_.bricksPerAxis().z(); }
    IndexBox layer(int n) const noexcept {
        const Eigen::Vector3i& bricks = map_.bricksPerAxis();
        IndexBox box = map_.voxelsOf({0, 0, n});
        box.include(map_.voxelsOf({bricks.x() - 1, bricks.y() - 1, n}));
        return {box.min + first_, box.max + first_};
    }
    template <class Sample>
    void fillLayer(int n, Sample&& sample) {
        const Eigen::Vector3i& bricks = map_.bricksPerAxis();
        std::vector<float> distances(BrickMap::kBrick);
        std::vector<MaterialId> nearest(BrickMap::kBrick);
        forEachIndex({{0, 0, n}, {bricks.x() - 1, bricks.y() - 1, n}}, [&](const Eigen::Vector3i& brick) {
            std::fill(distances.begin(), distances.end(), float(reach_));
            std::fill(nearest.begin(), nearest.end(), kNoMaterial);
            bool is_something = false;
            forEachIndex(map_.voxelsOf(brick), [&](const Eigen::Vector3i& v) {
                const auto [distance, id] = sample(Eigen::Vector3i(v + first_));
                if (!(distance < reach_)) return;
                is_something = true;
                distances[BrickMap::inBrick(v)] = float(std::max(distance, -reach_));
                nearest[BrickMap::inBrick(v)] = id;
            });
            if (!is_something) return;
            map_.addBrick(brick);
            distance_.insert(distance_.end(), distances.begin(), distances.end());
            nearest_.insert(nearest_.end(), nearest.begin(), nearest.end());
        });
    }

  private:
    void lookUp(const Eigen::Vector3i& voxel, double& distance, MaterialId& nearest) const noexcept {
        const size_t at = map_.find(voxel - first_);
        const bool is_known = at != BrickMap::kNowhere;
        distance = is_known ? double(distance_[at]) : reach_;
        nearest = is_known ? nearest_[at] : kNoMaterial;
    }

    Eigen::Vector3i first_;
    Eigen::Vector3d spacing_;
    double reach_;
    BrickMap map_;
    std::vector<float> distance_;  // not in units of the reach: that depends on which effects ask
    std::vector<MaterialId> nearest_;
};

inline DistanceSample DistanceField::at(const Eigen::Vector3d& p_V) const noexcept {
    constexpr double kFar = 1e6;  // voxels: what an int holds
    const Eigen::Array3d place = (p_V.array() / spacing_.array()).max(-kFar).min(kFar);
    const Eigen::Array3d low = place.floor();
    const Eigen::Array3d t = place - low;
    const Eigen::Vector3i voxel = low.cast<int>();
    double d[2][2][2];
    MaterialId nearest[2][2][2];
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i)
                lookUp(voxel + Eigen::Vector3i(i, j, k), d[k][j][i], nearest[k][j][i]);
    const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
    double x[2][2], dx[2][2], y[2], dy[2], dxy[2];
    for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
            x[k][j] = mix(d[k][j][0], d[k][j][1], t.x());
            dx[k][j] = d[k][j][1] - d[k][j][0];
        }
        y[k] = mix(x[k][0], x[k][1], t.y());
        dy[k] = x[k][1] - x[k][0];
        dxy[k] = mix(dx[k][0], dx[k][1], t.y());
    }
    const Eigen::Vector3d gradient(mix(dxy[0], dxy[1], t.z()), mix(dy[0], dy[1], t.z()), y[1] - y[0]);
    const MaterialId closest = nearest[t.z() >= 0.5][t.y() >= 0.5][t.x() >= 0.5];
    return {mix(y[0], y[1], t.z()), gradient.cwiseQuotient(spacing_), closest};
}

inline DistanceSample DistanceField::smoothAt(const Eigen::Vector3d& p_V) const noexcept {
    constexpr double kFar = 1e6;  // voxels: what an int holds
    const Eigen::Array3d place = (p_V.array() / spacing_.array()).max(-kFar).min(kFar);
    const Eigen::Array3d middle = place.round();
    const Eigen::Vector3i voxel = middle.cast<int>();
    double weight[3][3], slope[3][3];  // by axis, and voxel before, at and behind the middle
    for (int axis = 0; axis < 3; ++axis) {
        const double t = place[axis] - middle[axis], before = 0.5 - t, behind = 0.5 + t;
        weight[axis][0] = before * before / 2, weight[axis][1] = 0.75 - t * t;
        weight[axis][2] = behind * behind / 2;
        slope[axis][0] = -before, slope[axis][1] = -2 * t, slope[axis][2] = behind;
    }
    DistanceSample sum{0, Eigen::Vector3d::Zero(), kNoMaterial};
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                double d;
                MaterialId nearest;
                lookUp(voxel + Eigen::Vector3i(i - 1, j - 1, k - 1), d, nearest);
                if (i == 1 && j == 1 && k == 1) sum.nearest = nearest;
                const double x = weight[0][i], y = weight[1][j], z = weight[2][k];
                sum.distance += d * x * y * z;
                sum.gradient_V +=
                    d * Eigen::Vector3d(slope[0][i] * y * z, x * slope[1][j] * z, x * y * slope[2][k]);
            }
    sum.gradient_V = sum.gradient_V.cwiseQuotient(spacing_);
    return sum;
}

}  // namespace bonemill
