// For distances to round solids, every instruction set gives the bits of the baseline, and the
// baseline is right.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"
#include "tests/unit/haptic_server/core/kernels/every_level.h"

namespace bonemill {
namespace {

using test::expectSameBits;

class SolidKernels : public test::EveryLevel {};

template <class Scalar>
RoundSolid<Scalar> capsule() {
    return {{Scalar(0.1e-3), Scalar(-0.2e-3), Scalar(0.3e-3)},
            {0, Scalar(0.6), Scalar(0.8)},
            Scalar(4e-3),
            Scalar(1e-3)};
}

template <class Scalar>
double distanceTo(const RoundSolid<Scalar>& s, double x, double y, double z) {
    const double p[3] = {x - s.from[0], y - s.from[1], z - s.from[2]};
    const double along =
        std::clamp(p[0] * s.axis[0] + p[1] * s.axis[1] + p[2] * s.axis[2], 0.0, double(s.length));
    return std::hypot(p[0] - along * s.axis[0], p[1] - along * s.axis[1], p[2] - along * s.axis[2]) -
           s.radius;
}

TEST_P(SolidKernels, SingleAndDoublePrecisionPoints) {
    const auto check = [&]<class Scalar>(Scalar, double tolerance) {
        for (int round = 0; round < 50; ++round) {
            const int n = 1 + below(kContactBatch);
            const auto x = randoms<float>(n, -3e-3, 3e-3), y = randoms<float>(n, -3e-3, 3e-3),
                       z = randoms<float>(n, -3e-3, 5e-3);
            const FrameChange<Scalar> turn{
                {0, 0, 1, Scalar(0.8), Scalar(0.6), 0, Scalar(-0.6), Scalar(0.8), 0},
                {Scalar(1e-3), 0, Scalar(-1e-3)}};
            std::vector<Scalar> p[2][3], sample[2][4], nearer[2];
            for (const int which : {0, 1}) {
                const PointKernels<Scalar>& k = (which ? ours() : oracle()).template points<Scalar>();
                for (auto& v : p[which]) v.resize(size_t(n));
                k.into_frame(turn, x.data(), y.data(), z.data(), n, p[which][0].data(), p[which][1].data(),
                             p[which][2].data());
                nearer[which].assign(size_t(n), Scalar(1e-3));
                k.nearer_round(capsule<Scalar>(), p[which][0].data(), p[which][1].data(), p[which][2].data(),
                               n, nearer[which].data());
                for (auto& v : sample[which]) v.assign(size_t(n), Scalar(1e-3));
                k.sample_nearer_round(capsule<Scalar>(), p[which][0].data(), p[which][1].data(),
                                      p[which][2].data(), n, sample[which][0].data(), sample[which][1].data(),
                                      sample[which][2].data(), sample[which][3].data());
            }
            for (int axis = 0; axis < 3; ++axis) expectSameBits(p[0][axis], p[1][axis], n);
            expectSameBits(nearer[0], nearer[1], n);
            for (int part = 0; part < 4; ++part) expectSameBits(sample[0][part], sample[1][part], n);
            for (int i = 0; i < n; ++i) {
                const size_t at = size_t(i);
                EXPECT_NEAR(p[0][0][at], z[at] + 1e-3, tolerance);
                EXPECT_NEAR(p[0][1][at], 0.8 * (x[at] - 1e-3) + 0.6 * y[at], tolerance);
                const double distance = distanceTo(capsule<Scalar>(), p[0][0][at], p[0][1][at], p[0][2][at]);
                EXPECT_NEAR(nearer[0][at], std::min(distance, 1e-3), tolerance);
                EXPECT_NEAR(sample[0][0][at], std::min(distance, 1e-3), tolerance);
                if (distance >= 0.99e-3) continue;
                const double g = std::hypot(sample[0][1][at], sample[0][2][at], sample[0][3][at]);
                EXPECT_NEAR(g, 1, 1e-5);
            }
        }
    };
    check(float(), 1e-8);
    check(double(), 1e-15);
}

// The cone is in plain double precision; a PlainSample of a point is what the kernels' gradients can be
// judged by.
struct PlainCone {
    Eigen::Vector3d from, to;
    double radius[2];

    double length() const { return (to - from).norm(); }
    Eigen::Vector3d axis() const { return (to - from) / length(); }

    template <class Scalar>
    ConeSolid<Scalar> solid() const {
        const Eigen::Vector3d a = axis(), normal = a.unitOrthogonal();
        const Eigen::Vector2d side = Eigen::Vector2d(length(), radius[1] - radius[0]).normalized();
        ConeSolid<Scalar> s{};
        s.length = Scalar(length());
        for (int i = 0; i < 3; ++i)
            s.from[i] = Scalar(from[i]), s.axis[i] = Scalar(a[i]), s.normal[i] = Scalar(normal[i]);
        for (int i = 0; i < 2; ++i) s.radius[i] = Scalar(radius[i]), s.side[i] = Scalar(side[i]);
        return s;
    }
};

struct PlainSample {
    double distance;
    Eigen::Vector2d gradient;  // along and off the axis
    double off;                // of the point from the axis
    Eigen::Vector3d radial;
    double to_kink;  // where another part of the surface becomes the nearest
};

// Finds the nearest place of the profile's three segments, one after the other.
PlainSample sampleOf(const PlainCone& cone, const Eigen::Vector3d& p) {
    const double along = (p - cone.from).dot(cone.axis());
    const Eigen::Vector3d off = p - cone.from - along * cone.axis();
    const Eigen::Vector2d q(along, off.norm());
    const Eigen::Vector2d corners[] = {
        {0, 0}, {0, cone.radius[0]}, {cone.length(), cone.radius[1]}, {cone.length(), 0}};
    std::vector<Eigen::Vector2d> ways;
    for (int n = 0; n < 3; ++n) {
        const Eigen::Vector2d ab = corners[n + 1] - corners[n];
        const double u = ab.norm() > 0 ? (q - corners[n]).dot(ab) / ab.squaredNorm() : 0;
        ways.push_back(q - corners[n] - std::clamp(u, 0.0, 1.0) * ab);
    }
    std::sort(ways.begin(), ways.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
    const double rim = cone.radius[0] + (cone.radius[1] - cone.radius[0]) * along / cone.length();
    const bool is_inside = along > 0 && along < cone.length() && q.y() < rim;
    const double distance = is_inside ? -ways[0].norm() : ways[0].norm();
    return {distance, ways[0] / distance, q.y(), off.normalized(),
            is_inside ? std::min(ways[1].norm() - ways[0].norm(), q.y()) : 1.0};
}

const PlainCone kCones[] = {
    {{0, -1e-3, 0}, {0, 1.5e-3, 0.4e-3}, {1.1e-3, 0.3e-3}},
    {{0.1e-3, 0, 0.2e-3}, {1e-3, 1.5e-3, -1e-3}, {0.2e-3, 1.2e-3}},
    {{0, -1e-3, 0}, {0.5e-3, 1.5e-3, 0}, {0.8e-3, 0.8e-3}},            // cylinder
    {{0.3e-3, 0, 0}, {0.3e-3, 2e-3, 0}, {0.5e-3, 0.5e-3}},             // cylinder along y
    {{0, 0, -1e-3}, {0, 0, 1e-3}, {0.9e-3, 0}},                        // pointed
    {{0.2e-3, -0.3e-3, 0.1e-3}, {1e-3, 2e-3, 0.5e-3}, {0, 0.7e-3}},    // pointed at the other end
    {{0, 0.1e-3, 0}, {0.1e-3, 0.2e-3, 0.05e-3}, {0.2e-3, 2e-3}},       // a disc
    {{20e-3, -30e-3, 9e-3}, {20.5e-3, -10e-3, 9e-3}, {1e-3, 0.9e-3}},  // far from the origin
};

// The points lie anywhere, far outside, on the axis and near it, on each surface and on both sides of it.
std::vector<Eigen::Vector3d> pointsAround(const PlainCone& cone, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto anywhere = [&] { return Eigen::Vector3d(uniform(random), uniform(random), uniform(random)); };
    std::vector<Eigen::Vector3d> points;
    for (int n = 0; n < 300; ++n) {
        points.push_back((cone.from + cone.to) / 2 + 3e-3 * anywhere());
        points.push_back(0.1 * anywhere());
    }
    for (const double aside : {0.0, 1e-16, 1e-11, 1e-9, 1e-7})
        for (double u = -0.5; u <= 1.5; u += 0.0625)
            points.push_back(cone.from + u * (cone.to - cone.from) + aside * anywhere());
    const auto addAt = [&](double along, double off) {
        const Eigen::Vector3d sideways = anywhere().cross(cone.axis()).normalized();
        points.push_back(cone.from + along * cone.axis() + off * sideways);
    };
    for (const double away : {0.0, 1e-9, -1e-9, 1e-6, -1e-6, 3e-5, -3e-5})
        for (double u = 0; u <= 1; u += 0.125) {
            addAt(-away, u * cone.radius[0]);
            addAt(cone.length() + away, u * cone.radius[1]);
            addAt(u * cone.length(),
                  std::max(0.0, cone.radius[0] + u * (cone.radius[1] - cone.radius[0]) + away));
        }
    return points;
}

TEST_P(SolidKernels, ConesAndCylinders) {
    const auto check = [&]<class Scalar>(const PlainCone& cone) {
        const ConeSolid<Scalar> solid = cone.solid<Scalar>();
        const std::vector<Eigen::Vector3d> around = pointsAround(cone, random_);
        const int n = int(around.size());
        std::vector<Scalar> p[3], limit, sample[2][4], nearer[2];
        for (const Eigen::Vector3d& at : around)
            for (int axis = 0; axis < 3; ++axis) p[axis].push_back(Scalar(at[axis]));
        for (int i = 0; i < n; ++i) limit.push_back(i % 5 == 0 ? Scalar(0) : Scalar(1));
        for (const int which : {0, 1}) {
            const PointKernels<Scalar>& k = (which ? ours() : oracle()).template points<Scalar>();
            nearer[which] = sample[which][0] = limit;
            for (const int part : {1, 2, 3}) sample[which][part].assign(size_t(n), Scalar(7));
            k.nearer_cone(solid, p[0].data(), p[1].data(), p[2].data(), n, nearer[which].data());
            k.sample_nearer_cone(solid, p[0].data(), p[1].data(), p[2].data(), n, sample[which][0].data(),
                                 sample[which][1].data(), sample[which][2].data(), sample[which][3].data());
        }
        expectSameBits(nearer[0], nearer[1], n);
        expectSameBits(nearer[1], sample[1][0], n);
        for (int part = 0; part < 4; ++part) expectSameBits(sample[0][part], sample[1][part], n);
        constexpr double kEpsilon = std::numeric_limits<Scalar>::epsilon();
        constexpr double kOnAxis = 1e-12;  // m: nearer to it any normal will do
        for (size_t i = 0; i < size_t(n); ++i) {
            const Eigen::Vector3d at(p[0][i], p[1][i], p[2][i]);
            const Eigen::Vector3d gradient(sample[1][1][i], sample[1][2][i], sample[1][3][i]);
            const PlainSample plain = sampleOf(cone, at);
            const double tolerance = 4 * kEpsilon * (at.norm() + cone.from.norm() + cone.length());
            EXPECT_NEAR(nearer[1][i], std::min(plain.distance, double(limit[i])), tolerance);
            if (plain.distance > limit[i] + tolerance) {
                EXPECT_EQ(gradient, Eigen::Vector3d(7, 7, 7));
            }
            if (nearer[1][i] == limit[i]) continue;
            EXPECT_NEAR(gradient.norm(), 1, 8 * kEpsilon) << at.transpose();
            if (std::abs(plain.distance) < 10 * tolerance || plain.to_kink < 10 * tolerance) continue;
            const double blur = 4 * tolerance / std::abs(plain.distance) + 8 * kEpsilon;
            EXPECT_NEAR(gradient.dot(cone.axis()), plain.gradient.x(), blur) << at.transpose();
            if (plain.off < std::max(10 * tolerance, kOnAxis)) continue;
            EXPECT_NEAR(gradient.dot(plain.radial), plain.gradient.y(), blur + 4 * tolerance / plain.off);
        }
    };
    for (const PlainCone& cone : kCones) {
        check.operator()<float>(cone);
        check.operator()<double>(cone);
    }
}

TEST_P(SolidKernels, GradientOfAConeIsTheDistancesDerivative) {
    constexpr double kStep = 1e-9, kSmooth = 1e-4;
    for (const PlainCone& cone : kCones) {
        const ConeSolid<double> solid = cone.solid<double>();
        int smooth = 0;
        for (const Eigen::Vector3d& at : pointsAround(cone, random_)) {
            const PlainSample plain = sampleOf(cone, at);
            const bool is_inside = plain.distance < 0;
            if (plain.off < kSmooth || plain.to_kink < 4 * kStep) continue;
            if (is_inside ? plain.distance > -4 * kStep : plain.distance < kSmooth) continue;
            ++smooth;
            // The first place is the point itself; the others are one step ahead and one behind on each axis.
            constexpr int kPlaces = 7;
            double p[3][kPlaces], distance[kPlaces], g[3][kPlaces];
            std::fill_n(distance, kPlaces, 1);
            for (int axis = 0; axis < 3; ++axis) {
                std::fill_n(p[axis], kPlaces, at[axis]);
                p[axis][1 + axis] += kStep, p[axis][4 + axis] -= kStep;
            }
            ours().twice.sample_nearer_cone(solid, p[0], p[1], p[2], kPlaces, distance, g[0], g[1], g[2]);
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR((distance[1 + axis] - distance[4 + axis]) / (2 * kStep), g[axis][0], 1e-5);
        }
        EXPECT_GT(smooth, 200);
    }
}

INSTANTIATE_TEST_SUITE_P(Cpu, SolidKernels, testing::ValuesIn(kCpuLevels), test::levelName);

}  // namespace
}  // namespace bonemill
