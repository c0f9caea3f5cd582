#include "haptic_server/scans/densify/cubic_spline.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kPole = -0.26794919243112270647;  // sqrt(3) - 2
constexpr double kGain = 6;                        // (1 - pole) (1 - 1 / pole)

int mirrored(int index, int count) noexcept {
    if (count == 1) return 0;
    const int period = 2 * (count - 1);
    index = std::abs(index) % period;
    return index < count ? index : period - index;
}

}  // namespace

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

}  // namespace bonemill
