#include "common/geometry/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace bonemill {
namespace {

TEST(Pose, LogInvertsExpUpToPi) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (const double angle : {0.0, 1e-9, 5e-7, 2e-6, 1e-3, 1.0, 3.0, 3.1415}) {
        const Eigen::Vector3d theta =
            angle * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
        EXPECT_LT((logRotation(expRotation(theta)) - theta).norm(), 1e-12 * (1 + angle)) << angle;
    }
}

TEST(Pose, ExpIsTheMatrixExponentialOfTheSkewMatrix) {
    const Eigen::Vector3d theta(0.3, -0.8, 0.5);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d term = sum;
    for (int n = 1; n < 30; ++n) {
        term = term * skew(theta) / n;
        sum += term;
    }
    EXPECT_LT((expRotation(theta).toRotationMatrix() - sum).norm(), 1e-14);
}

TEST(Pose, LogTakesTheShorterWayForBothSigns) {
    const Eigen::Quaterniond q = expRotation({0.2, 0.1, -0.4});
    const Eigen::Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_LT((logRotation(q) - logRotation(minus_q)).norm(), 1e-15);
}

TEST(Pose, InverseAndIncrementFollowTheConventions) {
    const Pose X_AB{{1, 2, 3}, expRotation({0.5, 0.2, -0.1})};
    const Eigen::Vector3d p(0.3, -0.7, 0.2);
    EXPECT_LT((X_AB.inverse() * (X_AB * p) - p).norm(), 1e-15);
    const Eigen::Vector3d omega(0.01, -0.02, 0.03);
    const Pose moved = X_AB.incremented({0.1, 0, 0}, omega);
    EXPECT_LT((moved.rotation.toRotationMatrix() -
               expRotation(omega).toRotationMatrix() * X_AB.rotation.toRotationMatrix())
                  .norm(),
              1e-14);
    EXPECT_LT((moved.position - Eigen::Vector3d(1.1, 2, 3)).norm(), 1e-15);
}

TEST(Pose, TheRotationBetweenDirectionsIsTheShortest) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    const auto direction = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
    for (int n = 0; n < 1000; ++n) {
        const Eigen::Vector3d from = direction();
        // Every third pair is nearly opposite, by 1 rad down to 1e-16 rad.
        const Eigen::Vector3d to =
            n % 3 ? direction() : Eigen::Vector3d(-from + std::pow(10, -n / 60.0) * direction());
        const Eigen::Quaterniond rotation = rotationBetween(from, to);
        EXPECT_NEAR(rotation.norm(), 1, 1e-15);
        EXPECT_LT((rotation * from.normalized() - to.normalized()).norm(), 1e-7) << n;
        const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
        EXPECT_NEAR(logRotation(rotation).norm(), angle, 1e-7) << n;
    }
    EXPECT_LT(
        (rotationBetween({0, 2, 0}, {0, 0, 3}) * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(0, 0, 1)).norm(),
        1e-15);
    const Eigen::Quaterniond around = rotationBetween({0, 1, 0}, {0, -1, 0});
    EXPECT_LT((around * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-15);
    EXPECT_NEAR(logRotation(around).norm(), M_PI, 1e-15);
}

}  // namespace
}  // namespace bonemill
