#include "common/geometry/pose.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace bonemill
