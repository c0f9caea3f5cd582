#include "common/geometry/bounded_vector.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using Eigen::Vector3d;

TEST(BoundedVector, IsScaledInItsDirectionOnlyWhenTooLong) {
    Vector3d v(30, -40, 0);
    EXPECT_FALSE(limitLength(v, 50));
    EXPECT_EQ(v, Vector3d(30, -40, 0));
    EXPECT_TRUE(limitLength(v, 4));
    EXPECT_NEAR((v - Vector3d(2.4, -3.2, 0)).norm(), 0, 1e-12);
    EXPECT_EQ(bounded(Vector3d(1, 2, 3), 0), Vector3d::Zero());
    EXPECT_EQ(bounded(Vector3d::Zero().eval(), 0), Vector3d::Zero());
}

TEST(BoundedVector, KeepsItsDirectionHoweverLong) {
    const Vector3d direction = Vector3d(1, -2, 3).normalized();
    for (const double length : {1e-300, 1.0, 1e160, 1e300, 1e307})
        EXPECT_NEAR((bounded(length * direction, 1e-3) / std::min(length, 1e-3) - direction).norm(), 0, 1e-9)
            << length;
}

TEST(BoundedVector, AWrenchsForceAndTorqueHaveNormsOfTheirOwn) {
    const Wrench wrench = bounded({Vector3d(30, -40, 0), Vector3d(0, 0, 9)}, WrenchNorms{4, 0.2});
    EXPECT_NEAR((wrench.force - Vector3d(2.4, -3.2, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR((wrench.torque - Vector3d(0, 0, 0.2)).norm(), 0, 1e-12);
    const Wrench weak = bounded({Vector3d(1, 2, 3), Vector3d(0.1, 0, 0)}, WrenchNorms{4, 0});
    EXPECT_EQ(weak.force, Vector3d(1, 2, 3));
    EXPECT_EQ(weak.torque, Vector3d::Zero()) << "an arm without torque";
}

}  // namespace
}  // namespace bonemill
