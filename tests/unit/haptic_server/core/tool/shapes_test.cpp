#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/base/user_error.h"
#include "haptic_server/scene/tool_build/build_tool.h"

namespace bonemill {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The place and direction are any: the shape's own frame S has its `from` at the origin and its
// axis along +y.
const Pose kX_TS{Vector3d(0.4e-3, -0.3e-3, 0.7e-3), Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized()};

template <class Visit>
void forRandomPoints(int count, Visit&& visit) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-3.2e-3, 3.2e-3);
    for (int n = 0; n < count; ++n)
        visit(Vector3d(coordinate(random), coordinate(random), coordinate(random)));
}

double offAxis(const Vector3d& p_S) {
    return std::hypot(p_S.x(), p_S.z());
}

TEST(Shapes, Sphere) {
    const SphereShape sphere{{1e-3, 2e-3, 3e-3}, 0.5e-3};
    EXPECT_NEAR(signedDistance(sphere, {1e-3, 2e-3, 3e-3}), -0.5e-3, 1e-15);
    EXPECT_NEAR(signedDistance(sphere, {1e-3, 2e-3, 5e-3}), 1.5e-3, 1e-15);
    EXPECT_NEAR(signedDistance(sphere, {4e-3, 6e-3, 3e-3}), 4.5e-3, 1e-15);
}

TEST(Shapes, CapsuleInAnyDirection) {
    const double length = 3e-3, radius = 0.6e-3;
    const CapsuleShape capsule{kX_TS.position, kX_TS * Vector3d(0, length, 0), radius};
    forRandomPoints(5000, [&](const Vector3d& p_S) {
        const double beyond = std::max({0.0, -p_S.y(), p_S.y() - length});
        ASSERT_NEAR(signedDistance(capsule, kX_TS * p_S), std::hypot(offAxis(p_S), beyond) - radius, 1e-14);
    });
}

TEST(Shapes, CapsuleWithoutLengthIsABall) {
    const CapsuleShape capsule{{1e-3, 0, 0}, {1e-3, 0, 0}, 1e-3};
    EXPECT_NEAR(signedDistance(capsule, {1e-3, 3e-3, 0}), 2e-3, 1e-15);
}

TEST(Shapes, CylinderInAnyDirection) {
    const double length = 3e-3, radius = 0.6e-3;
    const CylinderShape cylinder{kX_TS.position, kX_TS * Vector3d(0, length, 0), radius};
    int inside = 0;
    forRandomPoints(5000, [&](const Vector3d& p_S) {
        const Vector2d beyond(offAxis(p_S) - radius, std::abs(p_S.y() - length / 2) - length / 2);
        const double expected = beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
        inside += expected < 0;
        ASSERT_NEAR(signedDistance(cylinder, kX_TS * p_S), expected, 1e-14);
    });
    EXPECT_GT(inside, 5);
}

// The oracle takes the nearest of many points on the profile's outline.
double coneOracle(const Vector2d& q, double length, double from_radius, double to_radius) {
    constexpr int kSamples = 4000;
    double nearest = 1;
    for (int n = 0; n <= kSamples; ++n) {
        const double t = double(n) / kSamples;
        const Vector2d side(t * length, from_radius + t * (to_radius - from_radius));
        nearest = std::min({nearest, (q - side).norm(), (q - Vector2d(0, t * from_radius)).norm(),
                            (q - Vector2d(length, t * to_radius)).norm()});
    }
    const double t = q.x() / length;
    const bool inside = t > 0 && t < 1 && q.y() < from_radius + t * (to_radius - from_radius);
    return inside ? -nearest : nearest;
}

TEST(Shapes, ConeInAnyDirection) {
    const double length = 3e-3;
    for (const Vector2d& radii : {Vector2d(1.5e-3, 0.5e-3), Vector2d(0, 2e-3), Vector2d(1e-3, 0)}) {
        const ConeShape cone{kX_TS.position, kX_TS * Vector3d(0, length, 0), radii[0], radii[1]};
        int inside = 0;
        forRandomPoints(500, [&](const Vector3d& p_S) {
            const double expected = coneOracle({p_S.y(), offAxis(p_S)}, length, radii[0], radii[1]);
            inside += expected < 0;
            // The nearest sample is at most half a step (about 0.5 µm) sideways at distance d, so that the
            // error is below step²/8d or step/2.
            ASSERT_NEAR(signedDistance(cone, kX_TS * p_S), expected, 0.5e-6);
        });
        EXPECT_GT(inside, 0);
    }
}

// The box is tight: it holds every inside point and touches the shape at all six sides.
void expectTightBox(const ToolShape& shape) {
    const Eigen::AlignedBox3d box = boundingBox(shape);
    forRandomPoints(5000,
                    [&](const Vector3d& p) { ASSERT_TRUE(signedDistance(shape, p) > 0 || box.contains(p)); });
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            double nearest = 1;
            for (int a = 0; a <= 300; ++a)
                for (int b = 0; b <= 300; ++b) {
                    Vector3d t = Vector3d::Zero();
                    t[axis] = upper;
                    t[(axis + 1) % 3] = a / 300.0;
                    t[(axis + 2) % 3] = b / 300.0;
                    nearest =
                        std::min(nearest, signedDistance(shape, box.min() + t.cwiseProduct(box.sizes())));
                }
            EXPECT_LT(nearest, 0.02e-3) << "axis " << axis << " upper " << upper;
            EXPECT_GT(nearest, -1e-9) << "axis " << axis << " upper " << upper;
        }
}

TEST(Shapes, BoxesAreTight) {
    const Vector3d from = kX_TS.position, to = kX_TS * Vector3d(0, 3e-3, 0);
    expectTightBox(SphereShape{from, 0.7e-3});
    expectTightBox(CapsuleShape{from, to, 0.7e-3});
    expectTightBox(CylinderShape{from, to, 0.7e-3});
    expectTightBox(ConeShape{from, to, 0.2e-3, 1.2e-3});
}

TEST(Shapes, RefusesWhatIsNoSolid) {
    const Vector3d zero = Vector3d::Zero(), y(0, 1e-3, 0), bad(0, std::nan(""), 0);
    EXPECT_NO_THROW(checkShape(CapsuleShape{zero, zero, 1e-3}, "s"));
    EXPECT_NO_THROW(checkShape(ConeShape{zero, y, 0, 1e-3}, "s"));
    for (const ToolShape& shape : std::vector<ToolShape>{
             SphereShape{zero, 0}, SphereShape{zero, -1e-3}, SphereShape{bad, 1e-3},
             CapsuleShape{zero, bad, 1e-3}, CapsuleShape{zero, y, std::nan("")}, CylinderShape{y, y, 1e-3},
             ConeShape{y, y, 1e-3, 1e-3}, ConeShape{zero, y, 0, 0}, ConeShape{zero, y, 1e-3, -1e-3}}) {
        try {
            checkShape(shape, "tool.shape[3]");
            ADD_FAILURE() << "shape kind " << shape.index() << " was accepted";
        } catch (const UserError& e) {
            EXPECT_EQ(std::string(e.what()).find("tool.shape[3] "), 0u) << e.what();
        }
    }
}

}  // namespace
}  // namespace bonemill
