#include "haptic_server/scans/densify/coarser.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

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

}  // namespace bonemill
