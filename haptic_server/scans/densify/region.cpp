#include "haptic_server/scans/densify/region.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "common/process/work_ahead.h"

namespace bonemill {
namespace {

// The means of `factor` slices, of which there are fewer at the end.
template <class T>
class SliceMeans {
  public:
    SliceMeans(const Eigen::Vector3i& from, const Eigen::Vector3i& to, int factor)
        : from_(from),
          to_(to),
          factor_(factor),
          sums_(size_t(to.x()) * size_t(to.y())),
          means_(sums_.size()) {}

    std::span<const T> of(std::span<const T> samples, int k) {
        const int last = std::min(from_.z(), (k + 1) * factor_);
        std::ranges::fill(sums_, Sum(0));
        for (int z = k * factor_; z < last; ++z)
            for (int y = 0; y < from_.y(); ++y)
                addRow(samples.data() + size_t(from_.x()) * (size_t(y) + size_t(from_.y()) * size_t(z)),
                       sums_.data() + size_t(to_.x()) * size_t(y / factor_));
        size_t at = 0;
        for (int y = 0; y < to_.y(); ++y)
            for (int x = 0; x < to_.x(); ++x, ++at)
                means_[at] =
                    mean(sums_[at], (last - k * factor_) * count(x, from_.x()) * count(y, from_.y()));
        return means_;
    }

  private:
    using Sum = std::conditional_t<std::is_integral_v<T>, int64_t, double>;

    int count(int index, int all) const { return std::min(factor_, all - index * factor_); }
    void addRow(const T* row, Sum* sums) const {
        for (int x = 0; x < from_.x(); x += factor_, ++sums)
            for (int n = 0; n < std::min(factor_, from_.x() - x); ++n) *sums += row[x + n];
    }
    static T mean(Sum sum, int voxels) {
        if constexpr (std::is_integral_v<T>)
            return T(std::lround(double(sum) / voxels));
        else
            return T(sum / voxels);
    }

    Eigen::Vector3i from_, to_;
    int factor_;
    std::vector<Sum> sums_;
    std::vector<T> means_;
};

constexpr double kPole = -0.26794919243112270647;  // sqrt(3) - 2
constexpr double kGain = 6;                        // (1 - pole) (1 - 1 / pole)

int mirrored(int index, int count) noexcept {
    if (count == 1) return 0;
    const int period = 2 * (count - 1);
    index = std::abs(index) % period;
    return index < count ? index : period - index;
}

// The scan's voxels around the region, as coefficients of the spline.
class SplineCoefficients {
  public:
    SplineCoefficients(const RawVolume& scan, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                       const ValueRange& band, double blur)
        : first_((low.array().floor().cast<int>() - kSplineReach).max(0)),
          dims_(((high.array().ceil().cast<int>() + kSplineReach + 1).min(scan.geometry.dims.array()) -
                 first_.array())) {
        read(scan, band);
        if (blur > 0) takeBack(blur, scan.geometry.spacing);
        for (int axis = 0; axis < 3; ++axis) filter(axis);
    }

    const Eigen::Vector3i& first() const noexcept { return first_; }
    const Eigen::Vector3i& dims() const noexcept { return dims_; }
    const float* row(int j, int k) const noexcept {
        return values_.data() + size_t(dims_.x()) * (size_t(j) + size_t(dims_.y()) * size_t(k));
    }

  private:
    void read(const RawVolume& scan, const ValueRange& range) {
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
    // change(line) for all lines along the axis.
    template <class Change>
    void forEachLine(int axis, Change&& change) {
        const std::array<size_t, 3> stride = {1, size_t(dims_.x()), size_t(dims_.x()) * size_t(dims_.y())};
        const auto length = size_t(dims_[axis]);
        std::vector<double> line(length);
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int b = 0; b < dims_[v]; ++b)
            for (int a = 0; a < dims_[u]; ++a) {
                float* const start =
                    values_.data() + size_t(a) * stride[size_t(u)] + size_t(b) * stride[size_t(v)];
                for (size_t n = 0; n < line.size(); ++n) line[n] = double(start[n * stride[size_t(axis)]]);
                change(line, start, stride[size_t(axis)]);
            }
    }
    void filter(int axis) {
        forEachLine(axis, [](std::vector<double>& line, float* start, size_t stride) {
            toSplineCoefficients(line);
            for (size_t n = 0; n < line.size(); ++n) start[n * stride] = float(line[n]);
        });
    }
    // A Gaussian blur adds half of its variance times the second derivatives, to first order.
    void takeBack(double blur, const Eigen::Vector3d& spacing) {
        const std::vector<float> scanned = values_;
        std::vector<float> sharp = scanned;
        for (int axis = 0; axis < 3; ++axis) {
            const double gain = blur * blur / 2 / (spacing[axis] * spacing[axis]);
            forEachLine(axis, [&](std::vector<double>& line, const float* start, size_t stride) {
                toSplineCoefficients(line);
                const size_t at = size_t(start - values_.data()), last = line.size() - 1;
                for (size_t n = 0; n <= last && last > 0; ++n) {
                    const double before = line[n > 0 ? n - 1 : 1], after = line[n < last ? n + 1 : last - 1];
                    sharp[at + n * stride] -= float(gain * (before - 2 * line[n] + after));
                }
            });
        }
        values_ = std::move(sharp);
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

// Slices begin .. end - 1 of the region.
struct Layers {
    int begin, end;
};

// Each of them takes a few of the scan's slices along its lower and its upper end, too.
std::vector<Layers> layersOf(int slices) {
    constexpr int kThick = 48;
    std::vector<Layers> layers;
    for (int begin = 0; begin < slices; begin += kThick)
        layers.push_back({begin, std::min(begin + kThick, slices)});
    return layers;
}

}  // namespace

RawVolume coarser(const RawVolume& scan, int factor) {
    RawVolume out;
    out.geometry.dims = (scan.geometry.dims.array() + factor - 1) / factor;
    out.geometry.spacing = factor * scan.geometry.spacing;
    out.geometry.X_WV = {scan.geometry.X_WV * Eigen::Vector3d((factor - 1) / 2.0 * scan.geometry.spacing),
                         scan.geometry.X_WV.rotation};
    out.description = scan.description;
    out.is_hounsfield = scan.is_hounsfield;
    out.lacks_patient_axes = scan.lacks_patient_axes;
    out.values.reserve(out.geometry.voxelCount());
    scan.values.visit([&]<class T>(std::span<const T> samples) {
        SliceMeans<T> means(scan.geometry.dims, out.geometry.dims, factor);
        for (int k = 0; k < out.geometry.dims.z(); ++k) out.values.append(means.of(samples, k));
    });
    return out;
}

void toSplineCoefficients(std::span<double> line) noexcept {
    const int count = int(line.size());
    if (count < 2) return;
    double first = 0, power = 1;
    for (int n = 0; n < 3 * kSplineReach; ++n, power *= kPole)
        first += power * line[size_t(mirrored(n, count))];
    line[0] = first;
    for (size_t n = 1; n < line.size(); ++n) line[n] += kPole * line[n - 1];
    const size_t last = line.size() - 1;
    line[last] = kPole / (kPole * kPole - 1) * (line[last] + kPole * line[last - 1]);
    for (size_t n = last; n-- > 0;) line[n] = kPole * (line[n + 1] - line[n]);
    for (double& coefficient : line) coefficient *= kGain;
}

SplineWeights splineWeightsAt(double at, int count) noexcept {
    const double low = std::floor(at), t = at - low, s = 1 - t;
    const double weights[] = {s * s * s / 6, 2.0 / 3 - t * t * (2 - t) / 2, 2.0 / 3 - s * s * (2 - s) / 2,
                              t * t * t / 6};
    SplineWeights result{};
    for (int n = 0; n < 4; ++n) {
        result.index[size_t(n)] = mirrored(int(low) - 1 + n, count);
        result.weight[size_t(n)] = float(weights[n]);
    }
    return result;
}

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

RawVolume resampleRegion(const RawVolume& scan, const VolumeGeometry& region, const ValueRange& band,
                         double blur) {
    const Eigen::Affine3d map = indexMap(region, scan.geometry);
    const Eigen::Vector3d low = map.translation(), step = map.linear().diagonal();
    const Eigen::Vector3d high = low + step.cwiseProduct((region.dims.array() - 1).matrix().cast<double>());
    const SplineCoefficients spline(scan, low, high, band, blur);
    RawVolume out;
    out.geometry = region;
    out.description = scan.description;
    out.is_hounsfield = scan.is_hounsfield;
    out.lacks_patient_axes = scan.lacks_patient_axes;
    out.values.reserve(region.voxelCount());
    const auto valuesOf = [&](const Layers& layers) {
        SliceMaker slices(spline, region.dims, low, step);
        RawValues values;
        std::vector<float> slice;
        for (int k = layers.begin; k < layers.end; ++k) {
            slices.make(k, slice);
            for (float& value : slice) {
                if (blur <= 0) value = std::clamp(value, float(band.low), float(band.high));
                if (band.are_integers) value = std::nearbyint(value);
            }
            values.append(std::span<const float>(slice));
        }
        return values;
    };
    workAhead(layersOf(region.dims.z()), valuesOf, [&](const Layers&, const RawValues& values) {
        values.visit([&](auto samples) { out.values.append(samples); });
    });
    return out;
}

LayersAround::LayersAround(const RawVolume& scan, const VolumeGeometry& region, const ValueRange& band,
                           double blur, int layers) {
    IndexBox inner{Eigen::Vector3i::Zero(), region.dims.array() - 1};
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool is_high : {false, true}) {
            IndexBox voxels = inner;
            voxels.min[axis] = is_high ? inner.max[axis] + 1 : inner.min[axis] - layers;
            voxels.max[axis] = voxels.min[axis] + layers - 1;
            VolumeGeometry slab = region;
            slab.dims = voxels.max - voxels.min + Eigen::Vector3i::Ones();
            slab.X_WV.position =
                region.X_WV * Eigen::Vector3d(region.spacing.cwiseProduct(voxels.min.cast<double>()));
            slabs_.push_back({voxels, resampleRegion(scan, slab, band, blur).values});
        }
        inner.min[axis] -= layers;
        inner.max[axis] += layers;
    }
}

double LayersAround::at(const Eigen::Vector3i& voxel) const {
    const auto slab = std::ranges::find_if(slabs_, [&](const Slab& s) { return s.voxels.contains(voxel); });
    const IndexBox& voxels = slab->voxels;
    return double(
        slab->values[placeIn(voxels.max - voxels.min + Eigen::Vector3i::Ones(), voxel - voxels.min)]);
}

}  // namespace bonemill
