#include "device_daemon/bridges/bridge/axes.h"

#include <gtest/gtest.h>

#include <limits>

#include "device_daemon/bridges/force_dimension/force_dimension_arm.h"
#include "device_daemon/bridges/haply/haply_arm.h"
#include "device_daemon/bridges/touch/touch_arm.h"

namespace bonemill::bridge {
namespace {

using Eigen::Vector3d;

// D's x points to the operator's left, y towards the operator, z up.
struct Directions {
    Eigen::Matrix3d axes;
    Vector3d right, to_operator, up;  // in the vendor's axes, as its documents say
};

const Directions kForceDimension{kForceDimensionAxes, Vector3d::UnitY(), Vector3d::UnitX(),
                                 Vector3d::UnitZ()};
const Directions kTouch{kTouchAxes, Vector3d::UnitX(), Vector3d::UnitZ(), Vector3d::UnitY()};
const Directions kHaply{kHaplyAxes, Vector3d::UnitX(), -Vector3d::UnitY(), Vector3d::UnitZ()};

TEST(Axes, EveryVendorsDirectionsAreThoseOfD) {
    for (const Directions& vendor : {kForceDimension, kTouch, kHaply}) {
        EXPECT_EQ(vendor.axes.determinant(), 1);
        EXPECT_EQ(vendor.axes * vendor.right, -Vector3d::UnitX());
        EXPECT_EQ(vendor.axes * vendor.to_operator, Vector3d::UnitY());
        EXPECT_EQ(vendor.axes * vendor.up, Vector3d::UnitZ());
    }
}

TEST(Axes, ATurnAboutAnAxisOfTheVendorIsOneAboutThatDirectionInD) {
    for (const Directions& vendor : {kForceDimension, kTouch, kHaply}) {
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, vendor.up));
        const Pose pose = poseInD(vendor.axes, vendor.to_operator, turn);
        EXPECT_NEAR((logRotation(pose.rotation) - Vector3d(0, 0, 0.4)).norm(), 0, 1e-12);
        EXPECT_NEAR((pose.position - Vector3d::UnitY()).norm(), 0, 1e-15);
        EXPECT_NEAR(
            logRotation(
                poseInD(vendor.axes, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()).rotation)
                .norm(),
            0, 1e-12);
    }
}

TEST(Axes, AWrenchGoesBackTheSameWay) {
    const Wrench wrench_D{Vector3d(1, 2, 3), Vector3d(4, 5, 6)};
    for (const Directions& vendor : {kForceDimension, kTouch, kHaply}) {
        const Wrench wrench_V = wrenchInV(vendor.axes, wrench_D);
        EXPECT_NEAR(wrench_V.force.dot(vendor.right), -1, 1e-15);
        EXPECT_NEAR(wrench_V.force.dot(vendor.to_operator), 2, 1e-15);
        EXPECT_NEAR(wrench_V.torque.dot(vendor.up), 6, 1e-15);
    }
}

TEST(Axes, ARotationThatIsNearlyOneIsRepaired) {
    const Eigen::Matrix3d exact = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    Eigen::Matrix3d skewed = exact;
    skewed.col(0) *= 1.003;
    skewed(2, 1) += 0.002;
    const auto repaired = repairedRotation(skewed);
    ASSERT_TRUE(repaired);
    EXPECT_NEAR(repaired->norm(), 1, 1e-14);
    EXPECT_LT(repaired->angularDistance(Eigen::Quaterniond(exact)), 0.003);
}

TEST(Axes, WhatIsFarFromARotationIsNone) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    EXPECT_FALSE(repairedRotation(Eigen::Matrix3d::Zero()));
    EXPECT_FALSE(repairedRotation(matrix * 1.5));
    matrix(2, 2) = -1;
    EXPECT_FALSE(repairedRotation(matrix)) << "a mirror";
    matrix(2, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(repairedRotation(matrix));
}

}  // namespace
}  // namespace bonemill::bridge
