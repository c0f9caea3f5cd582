#include <gtest/gtest.h>

#include <random>

#include "common/ares_kinematics/ares_kinematics.h"

namespace bonemill {
namespace {

Matrix6d neutralJacobian() {
    Matrix6d J_inv;
    EXPECT_TRUE(AresKinematics{}.inverseJacobian(Pose{}, J_inv));
    return J_inv;
}

Matrix6d randomMatrix(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    return Matrix6d::NullaryExpr([&] { return normal(random); });
}

TEST(Singularity, BothIndicesAreZeroWhenLegsCannotHoldThePlatform) {
    // With all links in one common direction there is no force sideways, and no torque about that axis.
    Matrix6d J_inv = neutralJacobian();
    EXPECT_GT(singularityIndex(J_inv), 0.25);
    for (int i = 0; i < kLegCount; ++i) J_inv.block<1, 3>(i, 0) = Eigen::RowVector3d(0, 0, 1);
    EXPECT_LT(singularityIndex(J_inv), 1e-7);
    EXPECT_LT(smoothIndex(J_inv), 1e-7);
    EXPECT_FALSE(actuatorForces(J_inv, {{1, 0, 0}, {0, 0, 0}}).allFinite());
}

TEST(Singularity, BothIndicesAreOneWhereEveryDirectionIsAlike) {
    Matrix6d J_inv = Matrix6d::Identity();
    J_inv.rightCols<3>() *= kConditioningLength;
    EXPECT_NEAR(singularityIndex(J_inv), 1, 1e-12);
    EXPECT_NEAR(smoothIndex(J_inv), 1, 1e-12);
}

TEST(Singularity, IndicesOfWhatIsNotANumberAreZero) {
    const Matrix6d nothing = Matrix6d::Constant(std::nan(""));
    EXPECT_EQ(singularityIndex(nothing), 0);
    EXPECT_EQ(smoothIndex(nothing), 0);
    EXPECT_EQ(singularityIndex(Matrix6d::Zero()), 0);
    EXPECT_EQ(smoothIndex(Matrix6d::Zero()), 0);
}

TEST(Singularity, TheSmoothIndexLiesBetweenTheIndexAndSixTimesIt) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 500; ++i) {
        const Matrix6d J_inv = randomMatrix(random);
        EXPECT_GE(smoothIndex(J_inv), singularityIndex(J_inv) * (1 - 1e-9));
        EXPECT_LE(smoothIndex(J_inv), 6 * singularityIndex(J_inv) * (1 + 1e-9));
    }
}

TEST(Singularity, ItsChangeMatchesFiniteDifferences) {
    std::mt19937_64 random(8);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 100; ++i) {
        const Matrix6d J_inv = neutralJacobian() + 0.01 * randomMatrix(random);
        const Matrix6d change = 0.1 * randomMatrix(random);
        const double above = smoothIndex(J_inv + kStep * change);
        const double below = smoothIndex(J_inv - kStep * change);
        EXPECT_NEAR(smoothIndexChange(J_inv, change), (above - below) / (2 * kStep), 1e-6);
    }
}

}  // namespace
}  // namespace bonemill
