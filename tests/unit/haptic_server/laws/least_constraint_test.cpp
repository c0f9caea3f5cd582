#include "haptic_server/laws/least_constraint.h"

#include <gtest/gtest.h>

#include <random>

namespace bonemill {
namespace {

Vector6d randomVector(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return Vector6d::NullaryExpr([&] { return normal(random); });
}

Matrix6d randomMetric(std::mt19937& random) {
    const Matrix6d half = Matrix6d::NullaryExpr([&] { return std::normal_distribution<double>()(random); });
    return half * half.transpose() + 0.1 * Matrix6d::Identity();
}

TEST(LeastConstraint, IsTheFreeMotionWhereNothingIsInTheWay) {
    std::mt19937 random(1);
    LeastConstraint problem(4);
    const Vector6d free = randomVector(random);
    problem.add(free, 0.9 * free.squaredNorm());
    const auto found = problem.solve(free, randomMetric(random));
    EXPECT_TRUE(found.motion.isApprox(free, 1e-12));
    EXPECT_EQ(found.active, 0);
    EXPECT_TRUE(found.reaction.isZero(0));
}

// Karush, Kuhn and Tucker: the motion is allowed, the reaction is what K (Δ - Δ_free) says, and it is a sum
// of pushes of rows that hold exactly.
TEST(LeastConstraint, FulfilsTheConditionsOfTheOptimum) {
    std::mt19937 random(2);
    int active = 0;
    for (int trial = 0; trial < 300; ++trial) {
        LeastConstraint problem(32);
        std::vector<Vector6d> rows;
        const Vector6d inside = randomVector(random), free = randomVector(random);
        std::vector<double> bounds;
        for (int n = 0; n < 1 + trial % 30; ++n) {
            rows.push_back(randomVector(random));
            bounds.push_back(rows.back().dot(inside) - 0.1 * std::abs(randomVector(random)[0]));
            problem.add(rows.back(), bounds.back());
        }
        const Matrix6d K = randomMetric(random);
        const auto found = problem.solve(free, K);
        EXPECT_TRUE(found.is_feasible);
        const Vector6d held = K * (found.motion - free);
        EXPECT_LT((held - found.reaction).norm(), 1e-6 * (1 + held.norm()));
        double slack_work = 0;  // Σ λ (J Δ - b), as reaction · (Δ - inside) <= Σ λ (b - J inside) < 0
        for (size_t n = 0; n < rows.size(); ++n)
            EXPECT_GT(rows[n].dot(found.motion) - bounds[n], -1e-7) << trial;
        slack_work = found.reaction.dot(found.motion - inside);
        EXPECT_LE(slack_work, 1e-6 * (1 + held.norm()));
        active += found.active;
    }
    EXPECT_GT(active, 300);
}

TEST(LeastConstraint, SaysSoWhenContactsContradictEachOther) {
    LeastConstraint problem(4);
    Vector6d up = Vector6d::Zero();
    up[2] = 1;
    problem.add(up, 1e-3);
    problem.add(-up, 1e-3);
    const auto found = problem.solve(Vector6d::Zero(), Matrix6d::Identity());
    EXPECT_FALSE(found.is_feasible);
    EXPECT_NEAR(std::abs(found.motion[2]), 1e-3, 1e-12);
}

TEST(LeastConstraint, HasAnAnswerForTheSameContactManyTimes) {
    LeastConstraint problem(64);
    Vector6d up = Vector6d::Zero(), down = Vector6d::Zero();
    up[2] = 1, down[2] = -3;
    for (int n = 0; n < 60; ++n) problem.add(up * (1 + 1e-9 * n), 0);
    const auto found = problem.solve(down, Matrix6d::Identity());
    EXPECT_TRUE(found.is_feasible);
    EXPECT_NEAR(found.motion.norm(), 0, 1e-9);
    EXPECT_NEAR(found.reaction[2], 3, 1e-6);
}

}  // namespace
}  // namespace bonemill
