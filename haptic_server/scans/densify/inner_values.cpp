#include "haptic_server/scans/densify/inner_values.h"

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

template <class T>
std::vector<T> largestAround(std::vector<T> values, const Eigen::Vector3i& dims,
                             const Eigen::Array3i& reach) {
    size_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
        values = largestAlong(values, stride, size_t(dims[axis]), size_t(reach[axis]));
        stride *= size_t(dims[axis]);
    }
    return values;
}

// Nothing lies between the surface and the voxels of a region that is no finer than the scan.
Eigen::Array3i reachOf(const Eigen::Vector3d& scan_spacing, const Eigen::Vector3d& spacing) {
    constexpr double kFiner = 1 + 1e-6, kRounding = 1e-6;
    const Eigen::Array3d ratio = scan_spacing.array() / spacing.array();
    return (ratio > kFiner).select((ratio / 2 + kRounding).floor(), 0.0).cast<int>();
}

}  // namespace

RawValues innerValues(const RawVolume& region, double iso_value, const Eigen::Vector3d& scan_spacing) {
    const VolumeGeometry& grid = region.geometry;
    const Eigen::Array3i reach = reachOf(scan_spacing, grid.spacing);
    return region.values.visit([&]<class T>(std::span<const T> samples) {
        std::vector<T> largest =
            largestAround(std::vector<T>(samples.begin(), samples.end()), grid.dims, reach);
        for (size_t n = 0; n < samples.size(); ++n)
            if (!(double(samples[n]) >= iso_value)) largest[n] = samples[n];
        RawValues inner;
        inner.append(std::move(largest));
        return inner;
    });
}

RawValues surfaceValues(const RawVolume& region, const RawValues& inner, double iso_value,
                        const Eigen::Vector3d& scan_spacing) {
    const VolumeGeometry& grid = region.geometry;
    return region.values.visit([&]<class T>(std::span<const T> samples) {
        std::vector<uint8_t> is_other(samples.size());
        for (size_t n = 0; n < samples.size(); ++n) is_other[n] = !(double(samples[n]) >= iso_value);
        is_other = largestAround(std::move(is_other), grid.dims, reachOf(scan_spacing, grid.spacing));
        std::vector<T> values(samples.begin(), samples.end());
        for (size_t n = 0; n < samples.size(); ++n)
            if (is_other[n]) values[n] = T(inner[n]);
        RawValues of_materials;
        of_materials.append(std::move(values));
        return of_materials;
    });
}

}  // namespace bonemill
