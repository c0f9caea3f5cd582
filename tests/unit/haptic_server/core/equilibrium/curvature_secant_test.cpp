#include <gtest/gtest.h>

#include <random>

#include "haptic_server/core/equilibrium/gradient_model.h"

namespace bonemill {
namespace {

Matrix6d randomMatrix(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return Matrix6d::NullaryExpr([&] { return normal(random); });
}
Vector6d randomStep(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return Vector6d::NullaryExpr([&] { return normal(random); });
}

TEST(CurvatureSecant, SaysHowTheGradientChangedOverTheLastStep) {
    std::mt19937 random(1);
    const Matrix6d A = randomMatrix(random), J = randomMatrix(random);
    const Matrix6d hessian = A * A.transpose(), gauss_newton = J * J.transpose();
    CurvatureSecant secant;
    EXPECT_TRUE(secant.isEmpty());
    for (int n = 0; n < 10; ++n) {
        const Vector6d step = randomStep(random);
        secant.learn(step, hessian * step, gauss_newton);
        const Vector6d foretold = (gauss_newton + secant.matrix()) * step;
        EXPECT_LE((foretold - hessian * step).norm(), 1e-9 * (hessian * step).norm());
        EXPECT_LE((secant.matrix() - secant.matrix().transpose()).norm(), 1e-9 * secant.matrix().norm());
    }
    EXPECT_FALSE(secant.isEmpty());
}

// Steps that Gauss-Newton makes six times too short end in a few, where alone it needs dozens.
TEST(CurvatureSecant, MakesASlowSolveQuick) {
    Matrix6d hessian = Matrix6d::Identity();
    Matrix6d gauss_newton = hessian;
    gauss_newton(0, 0) = gauss_newton(4, 4) = 6;
    CurvatureSecant secant;
    Vector6d learnt = Vector6d::Ones(), alone = Vector6d::Ones();
    for (int n = 0; n < 8; ++n) {
        const Vector6d step = -(gauss_newton + secant.matrix()).llt().solve(hessian * learnt);
        learnt += step;
        secant.learn(step, hessian * step, gauss_newton);
        alone -= gauss_newton.llt().solve(hessian * alone);
    }
    EXPECT_LE(learnt.norm(), 1e-4);
    EXPECT_GE(alone.norm(), 0.1);
}

// The contact has gone: the gradient changes as J'J says, and what was learnt goes, too.
TEST(CurvatureSecant, ForgetsWhereGaussNewtonIsRight) {
    std::mt19937 random(2);
    CurvatureSecant secant;
    secant.learn(Vector6d::UnitX(), 0.2 * Vector6d::UnitX(), Matrix6d::Identity());
    ASSERT_FALSE(secant.isEmpty());
    secant.learn(Vector6d::UnitX(), Vector6d::UnitX(), Matrix6d::Identity());
    EXPECT_LE(secant.matrix().norm(), 1e-12);
}

TEST(CurvatureSecant, LearnsNothingFromNonsense) {
    CurvatureSecant secant;
    secant.learn(Vector6d::Zero(), Vector6d::Zero(), Matrix6d::Identity());
    secant.learn(Vector6d::UnitX(), -Vector6d::UnitX(), Matrix6d::Identity());
    secant.learn(Vector6d::UnitX(), Vector6d::UnitY(), Matrix6d::Identity());
    secant.learn(Vector6d::UnitX(), Vector6d::Constant(NAN), Matrix6d::Identity());
    secant.learn(Vector6d::UnitX(), Vector6d::UnitX(), Matrix6d::Constant(INFINITY));
    EXPECT_TRUE(secant.isEmpty());
}

}  // namespace
}  // namespace bonemill
