// Compares the meters with a spring whose energies are known.
#include "tests/stability/energy_meter.h"

#include <gtest/gtest.h>

#include <vector>

namespace bonemill::test {
namespace {

constexpr double kSpring = 2000;  // N/m
constexpr double kDt = 1e-3, kSpeed = 0.05;
constexpr int kSteps = 100;

// The hand goes there and back at constant speed.
std::vector<double> strokes() {
    std::vector<double> x;
    for (int n = 0; n <= kSteps; ++n) x.push_back(n * kSpeed * kDt);
    for (int n = kSteps - 1; n >= 0; --n) x.push_back(n * kSpeed * kDt);
    return x;
}
Pose at(double x) {
    return {{x, 0, 0}, Eigen::Quaterniond::Identity()};
}
Wrench push(double x) {
    return {{-kSpring * x, 0, 0}, {0, 0, 0}};
}

TEST(AlgorithmEnergy, OfASpringIsWhatItStores) {
    AlgorithmEnergy meter;
    const double depth = kSteps * kSpeed * kDt;
    const std::vector<double> x = strokes();
    for (int n = 0; n <= kSteps; ++n) meter.add(at(x[size_t(n)]), push(x[size_t(n)]));
    EXPECT_NEAR(meter.energy(), kSpring * depth * depth / 2, 1e-12);
    for (size_t n = kSteps + 1; n < x.size(); ++n) meter.add(at(x[n]), push(x[n]));
    EXPECT_NEAR(meter.energy(), 0, 1e-12);
}

TEST(AlgorithmEnergy, OfATorsionSpringToo) {
    AlgorithmEnergy meter;
    const double k = 0.7, most = 0.4;
    const auto turned = [](double angle) { return Pose{{0, 0, 0}, expRotation({0, angle, 0})}; };
    for (int n = 0; n <= 100; ++n)
        meter.add(turned(most * n / 100), {{0, 0, 0}, {0, -k * most * n / 100, 0}});
    EXPECT_NEAR(meter.energy(), k * most * most / 2, 1e-9);
}

TEST(AlgorithmEnergy, SeesASourceOfEnergy) {
    AlgorithmEnergy meter;
    const std::vector<double> x = strokes();
    for (size_t n = 0; n < x.size(); ++n) meter.add(at(x[n]), push(n <= kSteps ? x[n] : 1.1 * x[n]));
    EXPECT_LT(meter.lowest(), -1e-3);
}

TEST(PortEnergy, OfAHeldSpringFallsByExactlyTheBound) {
    for (const int delay : {0, 1, 3}) {
        PortEnergy meter;
        const std::vector<double> x = strokes();
        for (size_t n = 0; n < x.size() + size_t(delay); ++n) {
            const double here = n < x.size() ? x[n] : 0;
            const double sampled = n >= size_t(delay) ? x[n - size_t(delay)] : 0;
            meter.add(at(here), push(sampled));
        }
        const double bound = PortEnergy::holdBound(kSpring, kDt, kSpeed, kSteps * kSpeed * kDt, delay);
        EXPECT_LE(meter.energy(), -0.9 * bound) << delay;
        EXPECT_GE(meter.energy(), -bound * (1 + 1e-9)) << delay;
    }
}

}  // namespace
}  // namespace bonemill::test
