#include "haptic_server/lab/accuracy_report/smooth_path.h"

#include <algorithm>

namespace bonemill {

PosePath smoothPath(const Eigen::Quaterniond& base, const std::vector<PathKnot>& knots, int ticks) {
    // End knots count three times: the spline starts and ends there.
    const int last = int(knots.size()) - 1;
    const auto knotAt = [&](int n) -> const PathKnot& { return knots[size_t(std::clamp(n - 2, 0, last))]; };
    const int segments = last + 2;
    PosePath path;
    for (int n = 0; n < ticks; ++n) {
        const double at = double(n) / std::max(1, ticks - 1) * segments;
        const int segment = std::min(int(at), segments - 1);
        const double t = at - segment, s = 1 - t;
        const double weights[] = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                  (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
        PathKnot knot{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
        for (int i = 0; i < 4; ++i) {
            knot.position += weights[i] * knotAt(segment + i).position;
            knot.rotation += weights[i] * knotAt(segment + i).rotation;
        }
        path.push_back({knot.position, (expRotation(knot.rotation) * base).normalized()});
    }
    return path;
}

}  // namespace bonemill
