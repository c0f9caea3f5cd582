#include "haptic_server/scans/densify/distance_transform.h"

#include <cmath>

namespace bonemill {
namespace {

// One parabola takes over from another at this place, in m of the line.
double crossing(double p, double f_p, double q, double f_q) {
    return (f_q + q * q - f_p - p * p) / (2 * (q - p));
}

}  // namespace

DistanceTransform::DistanceTransform(const IndexBox& box, const Eigen::Vector3d& spacing)
    : box_(box), spacing_(spacing), size_(box.max - box.min + Eigen::Vector3i::Ones()) {
    const size_t count = size_t(box.count());
    squared_.resize(count);
    id_.resize(count);
    along_z_.resize(count);
    const size_t longest = size_t(size_.maxCoeff());
    line_.resize(longest);
    hull_.resize(longest);
    from_.resize(longest + 1);
}

double DistanceTransform::distance(const Eigen::Vector3i& voxel) const {
    const size_t at = indexOf(voxel);
    const double squared = squared_[at];
    if (!(squared < kNone) || squared == 0) return squared;
    // Voxels are as wide as long in almost every scan, but often higher or flatter.
    const double flat = spacing_.x() * spacing_.y(), high = spacing_.z() * spacing_.z();
    const double z = along_z_[at] * spacing_.z();
    const double upright = z * z / squared;
    return std::sqrt(squared) - 0.5 * std::sqrt(upright * high + (1 - upright) * flat);
}

void DistanceTransform::runAxis(int axis) {
    const int across = axis == 0 ? 1 : 0, other = axis == 2 ? 1 : 2;
    size_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= size_t(size_[a]);
    for (int b = 0; b < size_[other]; ++b)
        for (int a = 0; a < size_[across]; ++a) {
            Eigen::Vector3i start = box_.min;
            start[across] += a;
            start[other] += b;
            runLine(indexOf(start), stride, size_[axis], spacing_[axis], axis == 2);
        }
}

void DistanceTransform::runLine(size_t start, size_t stride, int count, double step, bool is_z) {
    int hulls = 0;
    for (int n = 0; n < count; ++n) {
        line_[size_t(n)] = {squared_[start + size_t(n) * stride], id_[start + size_t(n) * stride]};
        if (!(line_[size_t(n)].squared < kNone)) continue;
        double from = -std::numeric_limits<double>::infinity();
        while (hulls > 0) {
            const int last = hull_[size_t(hulls - 1)];
            from = crossing(last * step, line_[size_t(last)].squared, n * step, line_[size_t(n)].squared);
            if (from > from_[size_t(hulls - 1)]) break;
            --hulls;
            from = -std::numeric_limits<double>::infinity();
        }
        hull_[size_t(hulls)] = n;
        from_[size_t(hulls++)] = from;
    }
    if (hulls == 0) return;
    int hull = 0;
    for (int n = 0; n < count; ++n) {
        while (hull + 1 < hulls && from_[size_t(hull + 1)] < n * step) ++hull;
        const int at = hull_[size_t(hull)];
        const double way = (n - at) * step;
        const size_t out = start + size_t(n) * stride;
        squared_[out] = float(way * way + line_[size_t(at)].squared);
        id_[out] = line_[size_t(at)].id;
        if (is_z) along_z_[out] = int16_t(n - at);
    }
}

}  // namespace bonemill
