#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "haptic_server/scans/densify/region.h"

namespace bonemill {
namespace {

double valueAt(const std::vector<double>& coefficients, double at) {
    const SplineWeights w = splineWeightsAt(at, int(coefficients.size()));
    double sum = 0;
    for (size_t n = 0; n < 4; ++n) sum += double(w.weight[n]) * coefficients[size_t(w.index[n])];
    return sum;
}

TEST(CubicSpline, GoesThroughItsSamplesToTheEnds) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> value(-1000, 2000);
    for (const size_t count : {1u, 2u, 3u, 5u, 40u}) {
        std::vector<double> samples(count);
        for (double& sample : samples) sample = value(random);
        std::vector<double> coefficients = samples;
        toSplineCoefficients(coefficients);
        for (size_t n = 0; n < count; ++n)
            EXPECT_NEAR(valueAt(coefficients, double(n)), samples[n], 2e-3) << n << " of " << count;
    }
}

TEST(CubicSpline, IsACubicWhereTheSamplesAreOne) {
    const auto cubic = [](double x) { return 3 + x * (0.7 + x * (-0.05 + 0.001 * x)); };
    std::vector<double> line;
    for (int n = 0; n < 60; ++n) line.push_back(cubic(n));
    toSplineCoefficients(line);
    for (double at = 20; at < 40; at += 0.13) EXPECT_NEAR(valueAt(line, at), cubic(at), 1e-4) << at;
}

// The mirrored end takes a slope away, and no more than that: a constant stays one everywhere.
TEST(CubicSpline, KeepsAConstant) {
    std::vector<double> line(9, 1234.5);
    toSplineCoefficients(line);
    for (double at = 0; at <= 8; at += 0.07) EXPECT_NEAR(valueAt(line, at), 1234.5, 2e-3) << at;
}

TEST(CubicSpline, OfAWaveIsNearerToItThanStraightLines) {
    const auto wave = [](double x) { return std::sin(2 * M_PI * x / 6); };
    std::vector<double> samples;
    for (int n = 0; n < 80; ++n) samples.push_back(wave(n));
    std::vector<double> line = samples;
    toSplineCoefficients(line);
    double spline = 0, straight = 0;
    for (double at = 30; at < 50; at += 0.05) {
        const auto low = size_t(at);
        const double t = at - double(low);
        spline = std::max(spline, std::abs(valueAt(line, at) - wave(at)));
        straight = std::max(straight, std::abs((1 - t) * samples[low] + t * samples[low + 1] - wave(at)));
    }
    EXPECT_LT(spline, 0.02);
    EXPECT_GT(straight, 5 * spline);
}

}  // namespace
}  // namespace bonemill
