// Along one step the advancement is conservative: no point tunnels through the tool.
#include <algorithm>
#include <cmath>

#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {
namespace {

constexpr int kMaxAdvances = 64;
constexpr double kMinAdvance = 1e-3;  // of the step
constexpr double kRounding = 2e-7;    // m, of two distances in single precision some cm from the tool point

}  // namespace

// This is the same for the whole sweep. A point at r from the tool point comes nearer by at most |x| + |ω| (r
// + |x|), r at the start.
void GradientContact::startSweep(const ToolField& tool, const Pose& X_VT, const Vector6d& step,
                                 double allowed_depth) noexcept {
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const float speed = float(step.head<3>().norm()), turn = float(step.tail<3>().norm());
    const float deepest = float(allowed_depth - kRounding);
    const IntoTool<float> into_tool(X_VT, origin_);
    PointBatch<float> batch;
    const Candidates& c = candidates_;
    for (size_t first = 0; first < c.count; first += kBatch) {
        into_tool.fill(batch, &c.x[first], &c.y[first], &c.z[first],
                       int(std::min<size_t>(kBatch, c.count - first)));
        tool.distances(batch, &lowest_[first]);
        for (int i = 0; i < batch.count; ++i) {
            const size_t n = first + size_t(i);
            const float r =
                std::sqrt(batch.x[i] * batch.x[i] + batch.y[i] * batch.y[i] + batch.z[i] * batch.z[i]);
            lowest_[n] = std::min(lowest_[n], 0.0f) - deepest;
            inverse_rate_[n] = 1 / (speed + turn * (r + speed));
        }
    }
}

// Returns the share of the step that can be gone from here without a look at the distances.
double GradientContact::sweptShare(const ToolField& tool, const Pose& X_VT) const noexcept {
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const IntoTool<float> into_tool(X_VT, origin_);
    PointBatch<float> batch;
    alignas(64) float distance[kBatch];
    const Candidates& c = candidates_;
    float least = 1;
    for (size_t first = 0; first < c.count; first += kBatch) {
        into_tool.fill(batch, &c.x[first], &c.y[first], &c.z[first],
                       int(std::min<size_t>(kBatch, c.count - first)));
        tool.distances(batch, distance);
        least = kernels().least_scaled(distance, &lowest_[first], &inverse_rate_[first], batch.count, least);
    }
    return std::max(0.0, double(least));
}

double GradientContact::advance(const ToolField& tool, const Pose& X_VT, const Vector6d& step,
                                double allowed_depth, size_t most_tests) noexcept {
    startSweep(tool, X_VT, step, allowed_depth);
    point_tests_ += candidates_.count;
    double t = 0;
    size_t tests = 0;
    for (int n = 0; n < kMaxAdvances && t < 1 && tests <= most_tests; ++n) {
        tests += candidates_.count;
        const double share = sweptShare(tool, X_VT.incremented(t * step.head<3>(), t * step.tail<3>()));
        t += share;
        if (share < kMinAdvance) break;
    }
    point_tests_ += tests;
    return std::min(t, 1.0);
}

}  // namespace bonemill
