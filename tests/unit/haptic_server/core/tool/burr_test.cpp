#include "haptic_server/core/tool/burr.h"

#include <gtest/gtest.h>

#include <random>

#include "haptic_server/core/tool/tool_shape.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr Burr kBall{.radius = 1.3e-3};
constexpr Burr kCylinder{.kind = BurrKind::kCylinder, .radius = 0.8e-3, .length = 3e-3};
constexpr Burr kCone{.kind = BurrKind::kCone, .radius = 1.2e-3, .length = 2e-3, .tip_radius = 0.4e-3};
constexpr Burr kPointed{.kind = BurrKind::kCone, .radius = 1.2e-3, .length = 2e-3};
constexpr Burr kInverted{.kind = BurrKind::kCone, .radius = 0.5e-3, .length = 2e-3, .tip_radius = 1e-3};
constexpr Burr kWheel{.kind = BurrKind::kCylinder, .radius = 2e-3, .length = 0.5e-3};

class BurrDistance : public testing::TestWithParam<Burr> {
  protected:
    // Gives points in and around the burr.
    template <class Visit>
    void forRandomPoints(int count, Visit&& visit) {
        std::mt19937 random(4);
        std::uniform_real_distribution<double> where(-1.5 * GetParam().reach(), 1.5 * GetParam().reach());
        for (int n = 0; n < count; ++n) visit(Vector3d(where(random), where(random), where(random)));
    }
    // It walks half of the profile, from the axis at the far end round to the axis at the hand's end.
    static Vector3d profile(const Burr& burr, double share) {
        if (burr.kind == BurrKind::kBall)
            return burr.radius * Vector3d(std::sin(M_PI * share), -std::cos(M_PI * share), 0);
        const double half = burr.length / 2;
        const double far = burr.kind == BurrKind::kCone ? burr.tip_radius : burr.radius;
        const Vector3d corners[4] = {{0, -half, 0}, {far, -half, 0}, {burr.radius, half, 0}, {0, half, 0}};
        const int part = std::min(2, int(3 * share));
        return corners[part] + (3 * share - part) * (corners[part + 1] - corners[part]);
    }
};

// The oracle takes the nearest of many places on the profile in the point's own half-plane.
TEST_P(BurrDistance, IsThatToTheNearestPlaceOfTheSurface) {
    forRandomPoints(100, [&](const Vector3d& p) {
        const Vector3d in_plane(std::hypot(p.x(), p.z()), p.y(), 0);
        constexpr int kPlaces = 6000;
        double nearest = 1;
        for (int n = 0; n <= kPlaces; ++n)
            nearest = std::min(nearest, (profile(GetParam(), double(n) / kPlaces) - in_plane).norm());
        EXPECT_NEAR(std::abs(GetParam().signedDistance(p)), nearest, 1e-6) << p.transpose();
    });
}

TEST_P(BurrDistance, HasASlopeOfOneAlongItsGradient) {
    constexpr double kStep = 1e-8;
    int smooth = 0;
    forRandomPoints(500, [&](const Vector3d& p) {
        Vector3d gradient, other;
        for (int axis = 0; axis < 3; ++axis) {
            const auto difference = [&](double step) {
                const Vector3d way = step * Vector3d::Unit(axis);
                return (GetParam().signedDistance(p + way) - GetParam().signedDistance(p - way)) / (2 * step);
            };
            gradient[axis] = difference(kStep);
            other[axis] = difference(30 * kStep);
        }
        if ((gradient - other).norm() > 1e-3) return;  // across a crease of the distance
        ++smooth;
        EXPECT_NEAR(gradient.norm(), 1, 2e-3) << p.transpose();
    });
    EXPECT_GT(smooth, 450);
}

TEST_P(BurrDistance, ReachesNoFartherThanItSays) {
    double farthest = 0;
    for (int n = 0; n <= 300; ++n) farthest = std::max(farthest, profile(GetParam(), n / 300.0).norm());
    EXPECT_NEAR(GetParam().reach(), farthest, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BurrDistance,
                         testing::Values(kBall, kCylinder, kCone, kPointed, kInverted, kWheel));

// The tool is made of these shapes when none are given.
TEST(BurrDistance, IsThatOfTheToolsShapes) {
    const auto expectSame = [](const Burr& burr, const ToolShape& shape) {
        std::mt19937 random(5);
        std::uniform_real_distribution<double> where(-2e-3, 2e-3);
        for (int n = 0; n < 200; ++n) {
            const Vector3d p(where(random), where(random), where(random));
            EXPECT_NEAR(burr.signedDistance(p), signedDistance(shape, p), 1e-15) << p.transpose();
        }
    };
    const auto half = [](const Burr& burr) -> Vector3d { return burr.length / 2 * Vector3d::UnitY(); };
    expectSame(kBall, SphereShape{Vector3d::Zero(), kBall.radius});
    expectSame(kCylinder, CylinderShape{-half(kCylinder), half(kCylinder), kCylinder.radius});
    expectSame(kCone, ConeShape{-half(kCone), half(kCone), kCone.tip_radius, kCone.radius});
    expectSame(kInverted,
               ConeShape{half(kInverted), -half(kInverted), kInverted.radius, kInverted.tip_radius});
}

}  // namespace
}  // namespace bonemill
