#include "haptic_server/volume/import/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/user_error.h"
#include "haptic_server/volume/import/cubic_spline.h"

namespace bonemill {
namespace {

constexpr double kRounding = 1e-6;  // voxels

// The scan's voxels around the region, as coefficients of the spline.
class SplineCoefficients {
  public:
    SplineCoefficients(const RawVolume& scan, const Eigen::Vector3d& low, const Eigen::Vector3d& high)
        : first_((low.array().floor().cast<int>() - kSplineReach).max(0)),
          dims_(((high.array().ceil().cast<int>() + kSplineReach + 1).min(scan.geometry.dims.array()) -
                 first_.array())) {
        read(scan);
        for (int axis = 0; axis < 3; ++axis) filter(axis);
    }

    const Eigen::Vector3i& first() const noexcept { return first_; }
    const Eigen::Vector3i& dims() const noexcept { return dims_; }
    const float* row(int j, int k) const noexcept {
        return values_.data() + size_t(dims_.x()) * (size_t(j) + size_t(dims_.y()) * size_t(k));
    }

  private:
    void read(const RawVolume& scan) {
        const ValueRange range = scan.values.range();
        const Eigen::Vector3i& dims = scan.geometry.dims;
        values_.reserve(size_t(dims_.x()) * size_t(dims_.y()) * size_t(dims_.z()));
        scan.values.visit([&](auto samples) {
            for (int k = 0; k < dims_.z(); ++k)
                for (int j = 0; j < dims_.y(); ++j) {
                    const size_t row = size_t(dims.x()) *
                                       (size_t(j + first_.y()) + size_t(dims.y()) * size_t(k + first_.z()));
                    for (int i = 0; i < dims_.x(); ++i) {
                        const auto value = double(samples[row + size_t(i + first_.x())]);
                        values_.push_back(
                            float(std::isnan(value) ? range.low : std::clamp(value, range.low, range.high)));
                    }
                }
        });
    }
    void filter(int axis) {
        const std::array<size_t, 3> stride = {1, size_t(dims_.x()), size_t(dims_.x()) * size_t(dims_.y())};
        std::vector<double> line(size_t(dims_[axis]));
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int b = 0; b < dims_[v]; ++b)
            for (int a = 0; a < dims_[u]; ++a) {
                float* const start =
                    values_.data() + size_t(a) * stride[size_t(u)] + size_t(b) * stride[size_t(v)];
                for (size_t n = 0; n < line.size(); ++n) line[n] = double(start[n * stride[size_t(axis)]]);
                toSplineCoefficients(line);
                for (size_t n = 0; n < line.size(); ++n) start[n * stride[size_t(axis)]] = float(line[n]);
            }
    }

    Eigen::Vector3i first_, dims_;
    std::vector<float> values_;
};

// Evaluates the spline slice by slice: along x and y each of the scan's slices once, along z from four of
// those.
class SliceMaker {
  public:
    SliceMaker(const SplineCoefficients& spline, const Eigen::Vector3i& dims, const Eigen::Vector3d& low,
               const Eigen::Vector3d& step)
        : spline_(spline), dims_(dims) {
        for (int axis = 0; axis < 3; ++axis)
            for (int n = 0; n < dims[axis]; ++n)
                weights_[size_t(axis)].push_back(
                    splineWeightsAt(low[axis] + n * step[axis] - spline.first()[axis], spline.dims()[axis]));
        for (Slice& slice : slices_) slice.values.resize(size_t(dims.x()) * size_t(dims.y()));
        row_.resize(size_t(dims.x()) * size_t(spline.dims().y()));
    }

    void make(int k, std::vector<float>& out) {
        const SplineWeights& w = weights_[2][size_t(k)];
        std::array<const float*, 4> from{};
        for (size_t n = 0; n < 4; ++n) from[n] = slice(w.index[n]);
        out.resize(slices_[0].values.size());
        for (size_t at = 0; at < out.size(); ++at)
            out[at] = w.weight[0] * from[0][at] + w.weight[1] * from[1][at] + w.weight[2] * from[2][at] +
                      w.weight[3] * from[3][at];
    }

  private:
    struct Slice {
        int k = -1;
        std::vector<float> values;
    };

    const float* slice(int k) {
        Slice& kept = slices_[size_t(k) % slices_.size()];
        if (kept.k != k) fill(kept, k);
        return kept.values.data();
    }
    void fill(Slice& slice, int k) {
        const auto nx = size_t(dims_.x());
        for (int j = 0; j < spline_.dims().y(); ++j) {
            const float* const from = spline_.row(j, k);
            for (size_t i = 0; i < nx; ++i) row_[nx * size_t(j) + i] = sum(weights_[0][i], from, 1);
        }
        for (size_t j = 0; j < size_t(dims_.y()); ++j)
            for (size_t i = 0; i < nx; ++i) slice.values[nx * j + i] = sum(weights_[1][j], &row_[i], nx);
        slice.k = k;
    }
    static float sum(const SplineWeights& w, const float* from, size_t stride) noexcept {
        float value = 0;
        for (size_t n = 0; n < 4; ++n) value += w.weight[n] * from[size_t(w.index[n]) * stride];
        return value;
    }

    const SplineCoefficients& spline_;
    Eigen::Vector3i dims_;
    std::array<std::vector<SplineWeights>, 3> weights_;
    std::array<Slice, 4> slices_;  // neighbours along z lie in different ones, mirrored or not
    std::vector<float> row_;
};

// Takes the voxel indices of `to` to those of `from`.
Eigen::Affine3d indexMap(const VolumeGeometry& to, const VolumeGeometry& from) {
    const Pose X = from.X_WV.inverse() * to.X_WV;
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() =
        from.spacing.cwiseInverse().asDiagonal() * X.rotation.toRotationMatrix() * to.spacing.asDiagonal();
    map.translation() = from.spacing.cwiseInverse().cwiseProduct(X.position);
    return map;
}

template <class Samples>
double labelAt(Samples samples, const Eigen::Vector3i& dims, const Eigen::Vector3d& at) {
    const Eigen::Vector3i low = at.array().floor().cast<int>();
    const Eigen::Vector3d t = at - low.cast<double>();
    std::array<double, 8> label{}, share{};
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i bit(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        const Eigen::Vector3i v = (low + bit).cwiseMax(0).cwiseMin(dims - Eigen::Vector3i::Ones());
        label[size_t(corner)] = double(
            samples[size_t(v.x()) + size_t(dims.x()) * (size_t(v.y()) + size_t(dims.y()) * size_t(v.z()))]);
        share[size_t(corner)] =
            (bit.x() ? t.x() : 1 - t.x()) * (bit.y() ? t.y() : 1 - t.y()) * (bit.z() ? t.z() : 1 - t.z());
    }
    double best = label[0], best_share = -1;
    for (size_t n = 0; n < 8; ++n) {
        double all = 0;
        for (size_t m = 0; m < 8; ++m) all += label[m] == label[n] ? share[m] : 0;
        if (all < best_share || (all == best_share && label[n] < best)) continue;
        best = label[n];
        best_share = all;
    }
    return best;
}

void checkCovers(const RawVolume& labels, const VolumeGeometry& region, const Eigen::Affine3d& map,
                 const std::string& label_file) {
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i bit(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        const Eigen::Vector3i last = region.dims.array() - 1;
        const Eigen::Vector3d at = map * bit.cwiseProduct(last).cast<double>();
        const Eigen::Array3d end = labels.geometry.dims.cast<double>().array() - 1;
        if ((at.array() < -0.5 - kRounding).any() || (at.array() > end + 0.5 + kRounding).any())
            throw UserError(label_file + " does not cover volume.region");
    }
    if (const ValueRange& range = labels.values.range(); !range.are_integers || range.non_finite > 0)
        throw UserError(label_file +
                        " holds values that are no whole numbers: labels are needed, not a scan");
}

}  // namespace

VolumeGeometry regionGeometry(const VolumeGeometry& scan, const Eigen::AlignedBox3d& box_W, double voxel) {
    Eigen::AlignedBox3d box_V;
    for (int corner = 0; corner < 8; ++corner)
        box_V.extend(scan.X_WV.inverse() * box_W.corner(Eigen::AlignedBox3d::CornerType(corner)));
    const Eigen::Vector3d end = scan.spacing.cwiseProduct((scan.dims.array() - 1).matrix().cast<double>());
    box_V = box_V.intersection(Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), end));
    VolumeGeometry region;
    region.spacing.setConstant(voxel);
    region.X_WV = {scan.X_WV * Eigen::Vector3d(box_V.min()), scan.X_WV.rotation};
    if (box_V.isEmpty()) return region;
    region.dims = (box_V.sizes() / voxel).array().floor().cast<int>() + 1;
    return region;
}

RawVolume resampleRegion(const RawVolume& scan, const VolumeGeometry& region) {
    const Eigen::Affine3d map = indexMap(region, scan.geometry);
    const Eigen::Vector3d low = map.translation(), step = map.linear().diagonal();
    const Eigen::Vector3d high = low + step.cwiseProduct((region.dims.array() - 1).matrix().cast<double>());
    const SplineCoefficients spline(scan, low, high);
    SliceMaker slices(spline, region.dims, low, step);
    RawVolume out;
    out.geometry = region;
    out.description = scan.description;
    out.is_hounsfield = scan.is_hounsfield;
    out.lacks_patient_axes = scan.lacks_patient_axes;
    out.values.reserve(region.voxelCount());
    const ValueRange& range = scan.values.range();
    std::vector<float> slice;
    for (int k = 0; k < region.dims.z(); ++k) {
        slices.make(k, slice);
        for (float& value : slice) {
            value = std::clamp(value, float(range.low), float(range.high));
            if (range.are_integers) value = std::nearbyint(value);
        }
        out.values.append(std::span<const float>(slice));
    }
    return out;
}

RawVolume resampleLabels(const RawVolume& labels, const VolumeGeometry& region,
                         const std::string& label_file) {
    const Eigen::Affine3d map = indexMap(region, labels.geometry);
    checkCovers(labels, region, map, label_file);
    RawVolume out;
    out.geometry = region;
    out.values.reserve(region.voxelCount());
    labels.values.visit([&](auto samples) {
        std::vector<float> slice;
        for (int k = 0; k < region.dims.z(); ++k) {
            slice.clear();
            for (int j = 0; j < region.dims.y(); ++j)
                for (int i = 0; i < region.dims.x(); ++i)
                    slice.push_back(
                        float(labelAt(samples, labels.geometry.dims, map * Eigen::Vector3d(i, j, k))));
            out.values.append(std::span<const float>(slice));
        }
    });
    return out;
}

}  // namespace bonemill
