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

// visit(candidate, its distance, its distance from the tool point)
template <class Visit>
void GradientContact::forEachDistance(const ToolField& tool, const Pose& X_VT, Visit&& visit) const noexcept {
    constexpr int kBatch = PointBatch<double>::kCapacity;
    const Pose X_TV = X_VT.inverse();
    PointBatch<double> batch;
    alignas(64) double distance[kBatch];
    for (size_t first = 0; first < count_; first += kBatch) {
        batch.count = int(std::min<size_t>(kBatch, count_ - first));
        for (int i = 0; i < batch.count; ++i) {
            const Vector3d p = X_TV * positionOf(candidates_[first + size_t(i)]);
            batch.x[i] = p.x(), batch.y[i] = p.y(), batch.z[i] = p.z();
        }
        tool.distances(batch, distance);
        for (int i = 0; i < batch.count; ++i)
            visit(first + size_t(i), distance[i],
                  std::sqrt(batch.x[i] * batch.x[i] + batch.y[i] * batch.y[i] + batch.z[i] * batch.z[i]));
    }
}

double GradientContact::advance(const ToolField& tool, const Pose& X_VT, const Vector6d& step,
                                double allowed_depth) noexcept {
    const double speed = step.head<3>().norm(), turn = step.tail<3>().norm();
    forEachDistance(tool, X_VT, [&](size_t i, double distance, double) {
        lowest_[i] = std::min(distance, 0.0) - allowed_depth;
    });
    // Each point's gap closes by at most `rate` per share of the step.
    const auto shareLeft = [&](double t) {
        double least = 1;
        const Pose X_VT_now = X_VT.incremented(t * step.head<3>(), t * step.tail<3>());
        forEachDistance(tool, X_VT_now, [&](size_t i, double distance, double r) {
            const double rate = speed + turn * (r + speed);
            if (rate > 0) least = std::min(least, std::max(0.0, distance - lowest_[i]) / rate);
        });
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
