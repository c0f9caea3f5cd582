#include "haptic_server/cases/phantom/analytic_body.h"

#include <gtest/gtest.h>

#include <random>

#include "haptic_server/core/volume/surface_ramp.h"
#include "tests/support/sampled_body.h"

namespace bonemill {
namespace {

const BodyKind kKinds[] = {BodyKind::kSlab, BodyKind::kSphere, BodyKind::kHole, BodyKind::kWedge,
                           BodyKind::kThinWall};

AnalyticBody bodyOf(BodyKind kind, std::mt19937& random) {
    std::uniform_real_distribution<double> number(-1, 1);
    AnalyticBody body;
    body.kind = kind;
    body.radius = 3e-3;
    body.thickness = 2.5e-3;
    body.angle = 0.8;
    body.X_WB.rotation =
        Eigen::Quaterniond(number(random), number(random), number(random), number(random)).normalized();
    body.X_WB.position = 1e-3 * Eigen::Vector3d(number(random), number(random), number(random));
    return body;
}

Eigen::Vector3d randomPoint(std::mt19937& random) {
    std::uniform_real_distribution<double> number(-8e-3, 8e-3);
    return {number(random), number(random), number(random)};
}

// A distance never changes faster than the point moves, and reaches zero within its own length along
// its gradient.
TEST(AnalyticBody, isADistance) {
    std::mt19937 random(5);
    for (const BodyKind kind : kKinds) {
        const AnalyticBody body = bodyOf(kind, random);
        for (int n = 0; n < 2000; ++n) {
            const Eigen::Vector3d p = randomPoint(random), q = randomPoint(random);
            const double d = signedDistance(body, p);
            EXPECT_LE(std::abs(d - signedDistance(body, q)), (p - q).norm() * (1 + 1e-12));
            constexpr double kStep = 1e-7;
            Eigen::Vector3d gradient;
            for (int a = 0; a < 3; ++a) {
                const Eigen::Vector3d e = kStep * Eigen::Vector3d::Unit(a);
                gradient[a] = (signedDistance(body, p + e) - signedDistance(body, p - e)) / (2 * kStep);
            }
            if (std::abs(gradient.norm() - 1) > 1e-3)
                continue;  // on a ridge, where two surfaces are equally near
            EXPECT_NEAR(signedDistance(body, p - gradient * d), 0, 1e-6);
        }
    }
}

TEST(AnalyticBody, insideIsWhereTheDefinitionSays) {
    std::mt19937 random(6);
    for (const BodyKind kind : kKinds) {
        const AnalyticBody body = bodyOf(kind, random);
        for (int n = 0; n < 5000; ++n) {
            const Eigen::Vector3d p_W = randomPoint(random);
            const Eigen::Vector3d p = body.X_WB.inverse() * p_W;
            const double half = body.thickness / 2;
            const bool inside[] = {std::abs(p.z()) <= half, p.norm() <= body.radius,
                                   std::abs(p.z()) <= half && p.head<2>().norm() >= body.radius,
                                   p.z() <= 0 && std::abs(p.x()) <= -p.z() * std::tan(body.angle / 2),
                                   std::abs(p.x()) <= half && p.z() <= 0};
            EXPECT_EQ(signedDistance(body, p_W) <= 0, inside[int(kind)]);
        }
    }
}

double trilinear(const RawVolume& raw, const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d index = (raw.geometry.X_WV.inverse() * p_W).cwiseQuotient(raw.geometry.spacing);
    const Eigen::Vector3i cell = index.array().floor().cast<int>();
    const Eigen::Vector3d f = index - cell.cast<double>();
    double value = 0;
    for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3i corner = cell + Eigen::Vector3i(c & 1, c >> 1 & 1, c >> 2 & 1);
        double weight = 1;
        for (int a = 0; a < 3; ++a) weight *= corner[a] == cell[a] ? 1 - f[a] : f[a];
        const auto& n = raw.geometry.dims;
        value += weight * raw.values[size_t(corner.x() + n.x() * (corner.y() + n.y() * corner.z()))];
    }
    return value;
}

// Returns the largest distance between the exact surface and the iso-surface of the samples,
// along random rays.
double surfaceError(const AnalyticBody& body, double voxel) {
    const int cells = int(14e-3 / voxel);
    const RawVolume raw = sampleBody(body, centredGrid(Eigen::Vector3i::Constant(cells), voxel), 65535);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> number(-5e-3, 5e-3);
    double worst = 0;
    for (int n = 0; n < 500; ++n) {
        const Eigen::Vector3d p(number(random), number(random), number(random));
        const double slope = 65535 / (2 * kRampVoxels * voxel);
        const double d = signedDistance(body, p);
        if (std::abs(d) > 0.3 * voxel) continue;  // unclamped and away from nothing else
        worst = std::max(worst, std::abs((65535 / 2.0 - trilinear(raw, p)) / slope - d));
    }
    return worst;
}

TEST(AnalyticBody, planeIsExactAndSphereConvergesWithTheSquareOfTheVoxel) {
    std::mt19937 random(8);
    AnalyticBody slab = bodyOf(BodyKind::kSlab, random);
    slab.thickness = 5e-3;
    EXPECT_LT(surfaceError(slab, 0.5e-3), 1e-7);  // rounding to 16 bit only
    AnalyticBody sphere;
    sphere.radius = 4e-3;
    const double coarse = surfaceError(sphere, 0.5e-3), fine = surfaceError(sphere, 0.25e-3);
    EXPECT_LT(coarse, 0.03e-3);
    EXPECT_LT(fine, coarse / 2.5);
}

}  // namespace
}  // namespace bonemill
