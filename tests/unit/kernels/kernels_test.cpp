// Every instruction set gives the bits of the baseline, and the baseline is right.
#include "haptic_server/kernels/kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "haptic_server/kernels/brick_layout.h"
#include "haptic_server/volume/voxel_volume.h"

namespace bonemill {
namespace {

class EveryLevel : public testing::TestWithParam<CpuLevel> {
  protected:
    void SetUp() override {
        if (!isSupported(GetParam())) GTEST_SKIP() << "this CPU has no " << cpuLevelName(GetParam());
    }
    const Kernels& ours() const { return kernelsOf(GetParam()); }
    const Kernels& oracle() const { return kernelsOf(CpuLevel::kBaseline); }

    template <class Scalar>
    std::vector<Scalar> randoms(int count, double low, double high) {
        std::uniform_real_distribution<double> uniform(low, high);
        std::vector<Scalar> values(size_t(count) + kCellLanes);
        for (Scalar& v : values) v = Scalar(uniform(random_));
        return values;
    }
    int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

    std::mt19937 random_{17};
};

template <class T>
void expectSameBits(const std::vector<T>& a, const std::vector<T>& b, int count) {
    EXPECT_EQ(std::memcmp(a.data(), b.data(), size_t(count) * sizeof(T)), 0);
}

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

TEST_P(EveryLevel, SingleAndDoublePrecisionPoints) {
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

// A cone in plain double precision; of a point, what the kernels' gradients can be judged by.
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

// The nearest place of the profile's three segments, one after the other.
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

// Anywhere, far outside, on the axis and near it, on each surface and on both sides of it.
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

TEST_P(EveryLevel, ConesAndCylinders) {
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

TEST_P(EveryLevel, GradientOfAConeIsTheDistancesDerivative) {
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
            // The point itself, then one step ahead and one behind on each axis.
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

TEST_P(EveryLevel, ContactSumsAreThoseOfPlainLoops) {
    const ContactFrame frame{{0, 0, 1, 0.8, 0.6, 0, -0.6, 0.8, 0}, {1e-4, 2e-4, -3e-4}, 0.2e-3};
    for (int round = 0; round < 100; ++round) {
        const int n = 1 + below(kContactBatch);
        const auto x = randoms<float>(n, -1e-3, 1e-3), y = randoms<float>(n, -1e-3, 1e-3),
                   z = randoms<float>(n, -1e-3, 1e-3), weight = randoms<float>(n, 10, 1e4),
                   depth = randoms<float>(n, -0.3e-3, -1e-9), gx = randoms<float>(n, -1, 1),
                   gy = randoms<float>(n, -1, 1), gz = randoms<float>(n, -1, 1);
        ContactSums sums[2];
        for (const int which : {0, 1})
            (which ? ours() : oracle())
                .single.add_contacts(frame, x.data(), y.data(), z.data(), weight.data(), depth.data(),
                                     gx.data(), gy.data(), gz.data(), n, sums[which]);
        EXPECT_EQ(std::memcmp(&sums[0], &sums[1], sizeof sums[0]), 0);
        double energy = 0, force_x = 0, torque_z = 0, k_xx = 0, k_zz = 0, deepest = 0;
        for (size_t i = 0; i < size_t(n); ++i) {
            const double d = -depth[i], capped = std::min(d, 0.2e-3), w = weight[i];
            const double g[3] = {gz[i], 0.8 * gx[i] + 0.6 * gy[i], -0.6 * gx[i] + 0.8 * gy[i]};
            const double r[2] = {x[i] - 1e-4, y[i] - 2e-4};
            const double k = d > 0.2e-3 ? w * 0.2e-3 / d : w, turning = r[0] * g[1] - r[1] * g[0];
            energy += w * capped * (d - capped / 2);
            force_x -= w * capped * g[0];
            torque_z -= w * capped * turning;
            k_xx += k * g[0] * g[0];
            k_zz += k * turning * turning;
            deepest = std::max(deepest, d);
        }
        EXPECT_NEAR(sums[0].energy, energy, 1e-9 * energy);
        EXPECT_NEAR(sums[0].force[0], force_x, 1e-6);
        EXPECT_NEAR(sums[0].torque[2], torque_z, 1e-9);
        EXPECT_NEAR(sums[0].stiffness[0], k_xx, 1e-6 * k_xx);
        EXPECT_NEAR(sums[0].stiffness[20], k_zz, 1e-6 * k_zz);
        EXPECT_EQ(sums[0].max_depth, deepest);
    }
}

// A plane of a brick against plain arithmetic in double.
TEST_P(EveryLevel, MilledPlanes) {
    const float spacing = 0.0973e-3f;  // no voxel exactly on a boundary
    for (int round = 0; round < 300; ++round) {
        const int n = 1 + below(kBrickCells), rows = 1 + below(kBrickCells);
        std::vector<uint16_t> plane(kBrickStrideZ), out[2];
        for (uint16_t& d : plane) d = uint16_t(below(3) == 0 ? below(65536) : below(2) * 65535);
        const bool removes = round % 2;
        const BurrPlane burr{.first_x = -float(below(20)) * spacing,
                             .step_x = spacing,
                             .first_y = -float(below(20)) * spacing,
                             .step_y = spacing,
                             .off_plane_squared = float(below(1000)) * 1e-9f,
                             .radius = 1e-3f,
                             .slope = 30000 / spacing,
                             .reach_squared = 1.1e-3f * 1.1e-3f,
                             .core_squared = 0.9e-3f * 0.9e-3f,
                             .iso = 30000,
                             .amount = 1 + below(65535)};
        MilledPlane milled[2];
        for (const int which : {0, 1}) {
            out[which].assign(kBrickCells * kBrickCells, 7);
            const Kernels& k = which ? ours() : oracle();
            milled[which] =
                (removes ? k.remove_plane : k.add_plane)(burr, plane.data(), n, rows, out[which].data());
        }
        EXPECT_EQ(std::memcmp(&milled[0], &milled[1], sizeof milled[0]), 0);
        int removed = 0, added = 0;
        for (int r = 0; r < rows; ++r) {
            const bool is_changed = milled[0].is_changed >> r & 1;
            bool is_any = false;
            for (int i = 0; i < n; ++i) {
                const double x = burr.first_x + i * double(spacing), y = burr.first_y + r * double(spacing),
                             squared = x * x + y * y + burr.off_plane_squared;
                const double ramp =
                    burr.iso - (removes ? -1 : 1) * burr.slope * (std::sqrt(squared) - burr.radius);
                double limit = std::clamp(ramp, 0.0, 65535.0);
                if (squared < burr.core_squared) limit = removes ? 0 : 65535;
                const uint16_t old = plane[size_t(r) * kBrickStrideY + size_t(i)];
                double now = removes ? std::min<double>(old, std::max(limit, double(old) - burr.amount))
                                     : std::max<double>(old, std::min(limit, double(old) + burr.amount));
                if (squared >= burr.reach_squared) now = old;
                const size_t at = size_t(r * kBrickCells + i);
                const uint16_t fresh = is_changed ? out[0][at] : old;
                if (is_changed) {
                    EXPECT_EQ(out[0][at], out[1][at]);
                }
                EXPECT_NEAR(fresh, now, 0.6) << i << ' ' << r;
                is_any |= fresh != old;
                removed += old >= burr.iso && fresh < burr.iso;
                added += old < burr.iso && fresh >= burr.iso;
            }
            EXPECT_EQ(is_changed, is_any);
        }
        EXPECT_EQ(milled[0].removed, removed);
        EXPECT_EQ(milled[0].added, added);
        EXPECT_EQ(milled[0].is_changed >> rows, 0u);
    }
}

TEST_P(EveryLevel, NearPointsOfABlock) {
    int all_near = 0, all_far = 0;
    for (int round = 0; round < 100; ++round) {
        const int n = 1 + below(kContactBatch);
        const auto distance = randoms<float>(n, -1e-3, 1e-3), area = randoms<float>(n, 1e-9, 1e-7);
        std::vector<std::vector<float>> g, m;  // gradient and normal
        for (int axis = 0; axis < 3; ++axis) {
            g.push_back(randoms<float>(n, -1, 1));
            m.push_back(randoms<float>(n, -1, 1));
        }
        const NearTest test{
            {0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f}, 0.5f, 500, 20e-6f, 50e-6f};
        std::vector<float> nearest[2];
        std::vector<int> selected[2];
        int found[2];
        for (const int which : {0, 1}) {
            nearest[which].resize(kContactBatch);
            selected[which].resize(kContactBatch);
            found[which] = (which ? ours() : oracle())
                               .select_near(test, distance.data(), g[0].data(), g[1].data(), g[2].data(),
                                            m[0].data(), m[1].data(), m[2].data(), area.data(), n,
                                            nearest[which].data(), selected[which].data());
        }
        ASSERT_EQ(found[0], found[1]);
        expectSameBits(nearest[0], nearest[1], n);
        expectSameBits(selected[0], selected[1], found[0]);
        int next = 0;
        for (size_t i = 0; i < size_t(n); ++i) {
            const Eigen::Vector3d g_V =
                Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(test.R_VT).cast<double>() *
                Eigen::Vector3d(g[0][i], g[1][i], g[2][i]);
            const double in_plane = g_V.cross(Eigen::Vector3d(m[0][i], m[1][i], m[2][i])).norm();
            const double place = distance[i] - in_plane * std::sqrt(0.5 * area[i]) - 500 * double(area[i]);
            EXPECT_NEAR(nearest[1][i], place, 1e-9);
            const bool is_near = distance[i] < test.margin || nearest[1][i] < test.refine_within;
            if (is_near) {
                ASSERT_LT(next, found[1]);
                EXPECT_EQ(selected[1][size_t(next++)], int(i));
            }
        }
        EXPECT_EQ(next, found[1]);
        all_near += next, all_far += n - next;
    }
    EXPECT_GT(all_near, 100);
    EXPECT_GT(all_far, 100);
}

TEST_P(EveryLevel, LeastScaledAndRanges) {
    for (int round = 0; round < 200; ++round) {
        const int n = 1 + below(100);
        const auto value = randoms<float>(n, -1, 1), lowest = randoms<float>(n, -1, 1),
                   scale = randoms<float>(n, 0, 9);
        float least = 0.25f;
        for (size_t i = 0; i < size_t(n); ++i) least = std::min(least, (value[i] - lowest[i]) * scale[i]);
        EXPECT_EQ(ours().least_scaled(value.data(), lowest.data(), scale.data(), n, 0.25f), least);

        const int width = 1 + below(40), rows = 1 + below(5);
        const size_t stride = size_t(width) + size_t(below(4));
        std::vector<uint16_t> box(stride * size_t(rows - 1) + size_t(width));
        for (uint16_t& d : box) d = uint16_t(20000 + below(10000));
        uint16_t low = 25000, high = 25000, expected_low = low, expected_high = high;
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < width; ++i) {
                const uint16_t d = box[size_t(r) * stride + size_t(i)];
                expected_low = std::min(expected_low, d), expected_high = std::max(expected_high, d);
            }
        ours().range_of_rows(box.data(), width, stride, rows, low, high);
        EXPECT_EQ(low, expected_low);
        EXPECT_EQ(high, expected_high);
    }
}

TEST_P(EveryLevel, SidesOfALayerOfCells) {
    constexpr uint16_t iso = 30000;
    for (int round = 0; round < 200; ++round) {
        const int columns = 2 + below(40), rows = 1 + below(6);
        const size_t stride_y = size_t(columns + below(4)), stride_z = stride_y * size_t(rows + 1);
        std::vector<uint16_t> voxels(2 * stride_z + kCellLanes);
        for (uint16_t& d : voxels) d = uint16_t(iso - 10 + below(20));
        const size_t row_size = size_t(columns + kCellLanes);
        std::vector<uint8_t> sides(row_size * size_t(rows));
        ours().cell_sides({voxels.data(), stride_y, stride_z}, columns, rows, iso, row_size, sides.data());
        for (int r = 0; r < rows; ++r) {
            const uint8_t* row = sides.data() + row_size * size_t(r);
            for (int i = 0; i < columns; ++i) {
                const uint16_t* v = voxels.data() + stride_y * size_t(r) + i;
                const int expected = (v[0] >= iso) | (v[stride_y] >= iso) << 2 | (v[stride_z] >= iso) << 4 |
                                     (v[stride_y + stride_z] >= iso) << 6;
                EXPECT_EQ(row[i], expected);
            }
            for (int i = 0; i < kCellsAtOnce; ++i) EXPECT_EQ(row[columns + i], row[columns - 1]);
        }
    }
}

// Cells of random densities; their patches, and the patches' centroids moved onto the surface.
struct CellCase {
    int count;
    std::vector<float> excess[8];
    std::vector<int> inside;
    CellArrays arrays() const {
        CellArrays a{{}, inside.data(), count};
        for (int c = 0; c < 8; ++c) a.excess[c] = excess[c].data();
        return a;
    }
};

double densityAt(const CellCase& cells, size_t n, double x, double y, double z) {
    double sum = 0;
    for (int c = 0; c < 8; ++c)
        sum += double(cells.excess[c][n]) * (c & 1 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 4 ? z : 1 - z);
    return sum;
}

TEST_P(EveryLevel, CellPatchesAndProjections) {
    // One triangle only is known here, cut off one corner: what marching cubes draws is tested elsewhere.
    std::vector<int> triangles(256 * kTrianglesPerCell, 0);
    for (int inside = 0; inside < 256; ++inside)
        triangles[size_t(inside) * kTrianglesPerCell] = 0 | 4 << 4 | 8 << 8;
    const float steps[3] = {1, 0.8f, 0.5f}, steepness[3] = {1, 1.5625f, 4}, inverse[3] = {1e3f, 1250, 2e3f};
    for (int round = 0; round < 50; ++round) {
        CellCase cells{1 + below(70), {}, {}};
        const size_t room = size_t(cells.count) + kCellLanes;
        cells.inside.assign(room, 1);
        for (int c = 0; c < 8; ++c)
            cells.excess[c] = randoms<float>(int(room), c == 0 ? 1 : -30000, c == 0 ? 30000 : -1);
        std::vector<float> patch[2][4], to[2][6];
        std::vector<int> found[2];
        for (const int which : {0, 1}) {
            const Kernels& k = which ? ours() : oracle();
            for (auto& v : patch[which]) v.resize(room);
            for (auto& v : to[which]) v.resize(room);
            found[which].resize(room);
            auto& p = patch[which];
            k.cell_patches(cells.arrays(), triangles.data(), steps,
                           {p[0].data(), p[1].data(), p[2].data(), p[3].data()});
            auto& t = to[which];
            for (size_t axis = 0; axis < 3; ++axis) t[axis] = p[axis + 1];
            k.project_into_cells(cells.arrays(), steepness, inverse, 1e-3f, 6,
                                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), t[4].data(),
                                  t[5].data(), found[which].data()});
        }
        for (int part = 0; part < 4; ++part) expectSameBits(patch[0][part], patch[1][part], cells.count);
        for (int part = 0; part < 6; ++part) expectSameBits(to[0][part], to[1][part], cells.count);
        expectSameBits(found[0], found[1], cells.count);
        for (size_t n = 0; n < size_t(cells.count); ++n) {
            double cut[3], largest = 0;  // how far along x, y and z the surface cuts the corner off
            for (int axis = 0; axis < 3; ++axis)
                cut[axis] = cells.excess[0][n] / double(cells.excess[0][n] - cells.excess[1 << axis][n]);
            for (int c = 0; c < 8; ++c) largest = std::max(largest, std::abs(double(cells.excess[c][n])));
            const double ax = cut[0] * 1, ay = cut[1] * 0.8, az = cut[2] * 0.5;
            EXPECT_NEAR(patch[0][0][n], std::hypot(ay * az, az * ax, ax * ay) / 2, 1e-5);
            for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(patch[0][axis + 1][n], cut[axis] / 3, 1e-4);
            if (!found[0][n]) continue;
            EXPECT_LE(std::abs(densityAt(cells, n, to[0][0][n], to[0][1][n], to[0][2][n])),
                      1.01e-3 * largest);
            EXPECT_NEAR(std::hypot(to[0][3][n], to[0][4][n], to[0][5][n]), 1, 1e-5);
        }
    }
}

// Onto a flat face between the voxels; where it is too far off, to the point's own place.
TEST_P(EveryLevel, PointsMoveOntoTheSurface) {
    constexpr int kEdge = 20;
    VolumeGeometry geometry;
    geometry.dims = Eigen::Vector3i::Constant(kEdge);
    VoxelVolume volume(geometry, 30000);
    volume.fill([](int i, int j, int k) {
        return Density(std::clamp(30000 + 2000 * (9.3 + 0.2 * i - 0.1 * j - k), 0.0, 65535.0));
    });
    const BrickStore& bricks = volume.bricks();
    const DensityView view{
        bricks.data(),         bricks.slots(), bricks.bricksPerAxis().x(), bricks.bricksPerAxis().y(),
        {kEdge, kEdge, kEdge}, 30000,          {1e3f, 1e3f, 1e3f},         {2e-3f, 1e-3f, 0}};
    for (int round = 0; round < 50; ++round) {
        const int n = 1 + below(60);
        const auto x = randoms<float>(n, 0, 15e-3), y = randoms<float>(n, 0, 15e-3),
                   off = randoms<float>(n, -1e-3, 1e-3), own = randoms<float>(n, 5e-3, 6e-3);
        std::vector<float> p[2][3], reach(x.size(), 0.5e-3f * 0.5e-3f);
        for (const int which : {0, 1}) {
            p[which][0] = x, p[which][1] = y, p[which][2] = off;
            for (size_t i = 0; i < x.size(); ++i)
                p[which][2][i] += float(1e-3 * (9.3 + 0.2 * (x[i] + 2e-3) * 1e3 - 0.1 * (y[i] + 1e-3) * 1e3));
            (which ? ours() : oracle())
                .move_onto_surface(view, 2,
                                   {p[which][0].data(), p[which][1].data(), p[which][2].data(), own.data(),
                                    own.data(), own.data(), reach.data(), n});
        }
        for (int axis = 0; axis < 3; ++axis) expectSameBits(p[0][axis], p[1][axis], n);
        for (size_t i = 0; i < size_t(n); ++i) {
            const double distance = std::abs(off[i]) / std::sqrt(1 + 0.04 + 0.01);
            if (distance > 0.51e-3) {
                EXPECT_EQ(p[0][2][i], own[i]);
            }
            if (distance > 0.49e-3) continue;
            const double on_face = 9.3 + 0.2 * (p[0][0][i] + 2e-3) * 1e3 - 0.1 * (p[0][1][i] + 1e-3) * 1e3;
            EXPECT_NEAR(p[0][2][i] * 1e3, on_face, 2e-3);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Cpu, EveryLevel, testing::ValuesIn(kCpuLevels), [](const auto& info) {
    return info.param == CpuLevel::kBaseline ? std::string("baseline")
                                             : std::string(cpuLevelName(info.param));
});

}  // namespace
}  // namespace bonemill
