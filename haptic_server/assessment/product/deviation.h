// What an attempt has changed: voxel by voxel, the pieces of the bone's surface around it, and how far that
// lies from the ideal one, in figures and as a picture: over-cut where it lies in bone that should have
// stayed, under-cut where it lies in what should be gone. The frame is V, the unit m.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Says of each voxel in a box what it was, is and shall be. It is read-only after construction.
class ChangeGrid {
  public:
    // Neither volume may be written meanwhile. It allocates a byte per voxel.
    ChangeGrid(const IndexBox& box, const VoxelVolume& scanned, const VoxelVolume& now,
               const JudgedTask& task);

    const IndexBox& box() const noexcept { return box_; }
    const Eigen::Vector3d& spacing() const noexcept { return spacing_; }

    // Outside of the box nothing is.
    bool wasBone(const Eigen::Vector3i& voxel) const noexcept { return at(voxel) & kWasBone; }
    bool isBone(const Eigen::Vector3i& voxel) const noexcept { return at(voxel) & kIsBone; }
    bool isRemoved(const Eigen::Vector3i& voxel) const noexcept {
        return (at(voxel) & (kWasBone | kIsBone)) == kWasBone;
    }
    // It was bone and shall be gone.
    bool isIdeal(const Eigen::Vector3i& voxel) const noexcept { return at(voxel) & kIsIdeal; }
    // It was bone and shall stay.
    bool staysIdeally(const Eigen::Vector3i& voxel) const noexcept {
        return (at(voxel) & (kWasBone | kIsIdeal)) == kWasBone;
    }
    bool isChangedOrIdeal(const Eigen::Vector3i& voxel) const noexcept {
        return isRemoved(voxel) || isIdeal(voxel);
    }

    Eigen::Vector3i voxelOf(const Eigen::Vector3d& p_V) const noexcept {
        return (p_V.array() / spacing_.array()).round().cast<int>();
    }

  private:
    static constexpr uint8_t kWasBone = 1, kIsBone = 2, kIsIdeal = 4;

    uint8_t at(const Eigen::Vector3i& voxel) const noexcept {
        if ((voxel.array() < box_.min.array()).any() || (voxel.array() > box_.max.array()).any()) return 0;
        const Eigen::Vector3i n = voxel - box_.min;
        return bits_[size_t(n.x()) + size_t(size_.x()) * (size_t(n.y()) + size_t(size_.y()) * size_t(n.z()))];
    }

    IndexBox box_;
    Eigen::Vector3i size_;
    Eigen::Vector3d spacing_;
    std::vector<uint8_t> bits_;
};

// Of the surface around what is gone, or should be: a triangle of marching cubes, as it is drawn.
struct CutPiece {
    Eigen::Vector3d center_V, normal_V;  // out of the bone
    double area;                         // m²
    bool is_judged;                      // something around it is removed, or should be
};

// All of the surface in the box. `now` may not be written meanwhile. It allocates.
std::vector<CutPiece> surfaceIn(const VoxelVolume& now, const ChangeGrid& changes);

// Values that stand for areas: mean, spread and percentiles by area.
class WeightedSample {
  public:
    void add(double value, double weight) { values_.push_back({value, weight}); }
    bool isEmpty() const noexcept { return values_.empty(); }

    double weight() const noexcept {
        double sum = 0;
        for (const auto& v : values_) sum += v.weight;
        return sum;
    }
    double mean() const noexcept {
        double sum = 0;
        for (const auto& v : values_) sum += v.weight * v.value;
        return sum / weight();
    }
    double deviation() const noexcept {
        const double middle = mean();
        double sum = 0;
        for (const auto& v : values_) sum += v.weight * (v.value - middle) * (v.value - middle);
        return std::sqrt(sum / weight());
    }
    // Of all weight, `share` (0 to 1) has values up to this one.
    double percentile(double share) const {
        std::vector<Value> sorted = values_;
        std::ranges::sort(sorted, {}, &Value::value);
        const double wanted = share * weight();
        double sum = 0;
        for (const Value& v : sorted)
            if ((sum += v.weight) >= wanted) return v.value;
        return sorted.back().value;
    }

  private:
    struct Value {
        double value, weight;
    };
    std::vector<Value> values_;
};

struct Deviation {
    std::vector<CutPiece> pieces;  // of the surface as it is now
    std::vector<double> distance;  // of each piece, m: positive is over-cut
};

// Of all pieces those that are judged; without an ideal surface in reach there is none.
Deviation deviationOf(const ChangeGrid& changes, const std::vector<CutPiece>& pieces);

// Adds the figures "overcut.*" and "undercut.*": mean, SD and 95th percentile by area, and maximum.
void addDeviationFigures(const Deviation& deviation, Figures& figures);

// A picture of what was cut: the bone's surface as the hand saw it, along the way into the bone, with what
// was cut too far in red and what was not cut far enough in blue.
struct DeviationPicture {
    std::string png;      // the file's bytes; empty without a surface
    double scale = 1e-3;  // m: from there on red and blue are full
};

// `context` is all of the surface around; `approach_V` of length 1 goes into the picture. `voxel` in m. The
// same input gives the same bytes (of one libpng).
DeviationPicture drawDeviation(const Deviation& deviation, const std::vector<CutPiece>& context,
                               const Eigen::Vector3d& approach_V, double voxel);

}  // namespace bonemill
