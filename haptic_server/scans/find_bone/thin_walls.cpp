#include "haptic_server/scans/find_bone/thin_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace bonemill {
namespace {

constexpr double kMinRise = 0.5;  // of the way from the higher end to the iso-value: noise rises less

double meanAbove(std::span<const float> samples, double iso) {
    double sum = 0, count = 0;
    for (const auto sample : samples)
        if (const auto value = double(sample); std::isfinite(value) && value >= iso) sum += value, ++count;
    return count > 0 ? sum / count : iso;
}

// Whole numbers are added without rounding, in any order.
template <class Integer>
double meanAbove(std::span<const Integer> samples, double iso) {
    const double least = std::ceil(iso);
    if (!(least <= double(std::numeric_limits<Integer>::max()))) return iso;
    const int first = int(std::max(least, double(std::numeric_limits<Integer>::lowest())));
    int64_t sum = 0, count = 0;
    for (const Integer sample : samples) {
        const bool is_above = sample >= first;
        sum += is_above ? sample : 0;
        count += is_above;
    }
    return count > 0 ? double(sum) / double(count) : iso;
}

// In voxels along the axis; 0: it is none.
template <class Samples>
double wallAt(Samples samples, size_t at, size_t stride, double iso, double bone) {
    std::array<double, 5> v{};
    for (size_t n = 0; n < 5; ++n) v[n] = double(samples[at + n * stride - 2 * stride]);
    const double base = std::max(v[0], v[4]);
    if (!(v[2] > v[1] && v[2] > v[3] && v[2] < iso && v[2] - base >= kMinRise * (iso - base))) return 0;
    double sum = 0;
    for (const double value : v) sum += std::max(0.0, value - base);
    return sum / (bone - base);
}

}  // namespace

ThinWalls findThinWalls(const RawVolume& scan, const IndexBox& within, double iso_value) {
    const Eigen::Vector3i& dims = scan.geometry.dims;
    const std::array<size_t, 3> stride = {1, size_t(dims.x()), size_t(dims.x()) * size_t(dims.y())};
    std::vector<float> found;
    scan.values.visit([&](auto samples) {
        const double bone = meanAbove(samples, iso_value);
        forEachIndex(within, [&](const Eigen::Vector3i& v) {
            const size_t at = size_t(v.x()) + stride[1] * size_t(v.y()) + stride[2] * size_t(v.z());
            if (!(double(samples[at]) < iso_value)) return;
            double thinnest = 0;
            for (int axis = 0; axis < 3; ++axis) {
                if (v[axis] < 2 || v[axis] + 2 >= dims[axis]) continue;
                const double wall =
                    scan.geometry.spacing[axis] * wallAt(samples, at, stride[size_t(axis)], iso_value, bone);
                if (wall > 0 && (thinnest == 0 || wall < thinnest)) thinnest = wall;
            }
            if (thinnest > 0) found.push_back(float(thinnest));
        });
    });
    ThinWalls walls{.voxels = found.size()};
    if (found.empty()) return walls;
    const auto middle = found.begin() + ptrdiff_t(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    walls.median_thickness = double(*middle);
    return walls;
}

}  // namespace bonemill
