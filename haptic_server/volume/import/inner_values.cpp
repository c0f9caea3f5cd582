#include "haptic_server/volume/import/inner_values.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace bonemill {
namespace {

// Each value becomes the largest of those up to `reach` places before and behind it along one axis, whose
// places are `stride` values apart; NaN counts for nothing.
template <class T>
std::vector<T> largestAlong(const std::vector<T>& values, size_t stride, size_t places, size_t reach) {
    if (reach == 0) return values;
    std::vector<T> largest = values;
    const size_t block = stride * places;
    for (size_t first = 0; first < values.size(); first += block)
        for (size_t place = 0; place < places; ++place) {
            const std::span<T> out(&largest[first + place * stride], stride);
            const size_t low = place - std::min(place, reach), high = std::min(place + reach, places - 1);
            for (size_t other = low; other <= high; ++other) {
                const T* const in = &values[first + other * stride];
                for (size_t n = 0; n < stride; ++n) out[n] = in[n] > out[n] ? in[n] : out[n];
            }
        }
    return largest;
}

// Nothing lies between the surface and the voxels of a region that is no finer than the scan.
Eigen::Array3i reachOf(const Eigen::Vector3d& scan_spacing, const Eigen::Vector3d& spacing) {
    constexpr double kFiner = 1 + 1e-6;
    const Eigen::Array3d ratio = scan_spacing.array() / spacing.array();
    return (ratio > kFiner).select((ratio / 2).round(), 0.0).cast<int>();
}

}  // namespace

RawValues innerValues(const RawVolume& region, double iso_value, const Eigen::Vector3d& scan_spacing) {
    const VolumeGeometry& grid = region.geometry;
    const Eigen::Array3i reach = reachOf(scan_spacing, grid.spacing);
    return region.values.visit([&]<class T>(std::span<const T> samples) {
        std::vector<T> largest(samples.begin(), samples.end());
        size_t stride = 1;
        for (int axis = 0; axis < 3; ++axis) {
            largest = largestAlong(largest, stride, size_t(grid.dims[axis]), size_t(reach[axis]));
            stride *= size_t(grid.dims[axis]);
        }
        for (size_t n = 0; n < samples.size(); ++n)
            if (!(double(samples[n]) >= iso_value)) largest[n] = samples[n];
        RawValues inner;
        inner.append(std::move(largest));
        return inner;
    });
}

}  // namespace bonemill
