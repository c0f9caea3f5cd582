#include "haptic_server/assessment/measures/expert_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bonemill {
namespace {

Pose turnedAboutZ(double x, double angle) {
    return {{x, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))};
}

TEST(ExpertPath, ATimeBetweenTwoPointsHasItsShareOfBoth) {
    const ExpertPath path({{1, turnedAboutZ(0, 0)}, {3, turnedAboutZ(4, 1)}, {4, turnedAboutZ(4, 1)}});
    const auto between = path.at(1.5);
    ASSERT_TRUE(between);
    EXPECT_NEAR(between->position.x(), 1, 1e-15);
    EXPECT_NEAR(between->rotation.angularDistance(turnedAboutZ(0, 0.25).rotation), 0, 1e-7);
    EXPECT_EQ(path.at(1)->position.x(), 0);
    EXPECT_EQ(path.at(4)->position.x(), 4);
}

TEST(ExpertPath, ThereIsNobodyBeforeTheFirstPointAndAfterTheLast) {
    const ExpertPath path({{1, Pose{}}, {3, Pose{}}});
    EXPECT_FALSE(path.at(0.999));
    EXPECT_FALSE(path.at(3.001));
    EXPECT_FALSE(path.at(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(ExpertPath({}).at(0));
}

}  // namespace
}  // namespace bonemill
