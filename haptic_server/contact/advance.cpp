// Continuous collision: how far the tool may go along a step.
#include <algorithm>
#include <cmath>

#include "haptic_server/contact/gradient_contact.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kMostAdvances = 24;
constexpr double kSmallestAdvance = 1e-3;  // of the step

}  // namespace

double GradientContact::advance(const ToolField& tool, const Pose& X_VT, const Vector6d& step,
                                double allowed_depth) const noexcept {
    constexpr int kBatch = PointBatch<double>::kCapacity;
    const double speed = step.head<3>().norm(), turn = step.tail<3>().norm();
    PointBatch<double> batch;
    alignas(64) double at_start[kBatch], distance[kBatch];
    // Each point's gap closes by at most `rate` per share of the step.
    const auto shareLeft = [&](double t) {
        const Pose X_TV = X_VT.incremented(t * step.head<3>(), t * step.tail<3>()).inverse();
        const Pose X_TV_start = X_VT.inverse();
        double least = 1;
        for (size_t first = 0; first < count_; first += kBatch) {
            const int count = int(std::min<size_t>(kBatch, count_ - first));
            const auto fill = [&](const Pose& X) {
                batch.count = count;
                for (int i = 0; i < count; ++i) {
                    const Vector3d p = X * positionOf(candidates_[first + size_t(i)]);
                    batch.x[i] = p.x(), batch.y[i] = p.y(), batch.z[i] = p.z();
                }
            };
            fill(X_TV_start);
            tool.distances(batch, at_start);
            fill(X_TV);
            tool.distances(batch, distance);
            for (int i = 0; i < count; ++i) {
                const double lowest = std::min(at_start[i], 0.0) - allowed_depth;
                const double r =
                    std::sqrt(batch.x[i] * batch.x[i] + batch.y[i] * batch.y[i] + batch.z[i] * batch.z[i]);
                const double rate = speed + turn * (r + speed);
                if (rate > 0) least = std::min(least, std::max(0.0, distance[i] - lowest) / rate);
            }
        }
        return least;
    };
    double t = 0;
    for (int n = 0; n < kMostAdvances; ++n) {
        const double share = shareLeft(t);
        t = std::min(1.0, t + share);
        if (t == 1 || share < kSmallestAdvance) break;
    }
    return t;
}

}  // namespace bonemill
