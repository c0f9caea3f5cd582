// Deflections become rates through dead zone and curve, and rates become a wish that never leaves its leash.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "device_daemon/hands/input/rate_device.h"

namespace bonemill {
namespace {

constexpr double kDead = 0.1;
constexpr Leash kLeash{.distance = 0.013, .angle = 0.1};

TEST(RateResponse, IsNothingWithinTheDeadZoneAndStartsThereWithoutAJump) {
    for (const double d : {0.0, 0.05, -0.1, 0.1}) EXPECT_EQ(responseOf(d, kDead), 0) << d;
    EXPECT_GT(responseOf(kDead + 1e-6, kDead), 0);
    EXPECT_LT(responseOf(kDead + 1e-6, kDead), 1e-6);
}

TEST(RateResponse, GrowsAllTheWayMoreSlowlyAtFirstAndEndsAtOne) {
    double before = 0;
    for (double d = kDead + 0.01; d <= 1; d += 0.01) {
        EXPECT_GT(responseOf(d, kDead), before);
        EXPECT_LE(responseOf(d, kDead), d);
        EXPECT_EQ(responseOf(-d, kDead), -responseOf(d, kDead));
        before = responseOf(d, kDead);
    }
    EXPECT_EQ(responseOf(1, kDead), 1);
    EXPECT_EQ(responseOf(-7, kDead), -1);
    // A quarter of a straight line and three quarters of a cubic one, in the middle of what is alive.
    EXPECT_NEAR(responseOf(0.55, kDead), 0.25 * 0.5 + 0.75 * 0.125, 1e-12);
}

TEST(RateResponse, TakesNonsenseForNothingOrFull) {
    EXPECT_EQ(responseOf(std::numeric_limits<double>::quiet_NaN(), kDead), 0);
    EXPECT_EQ(responseOf(std::numeric_limits<double>::infinity(), kDead), 1);
}

TEST(Rates, ADiagonalIsNoFasterThanAnAxis) {
    const RateConfig config;
    const Rates axis = ratesOf({0, 1, 0, 0, 0, -1}, false, config);
    EXPECT_TRUE(axis.v_D.isApprox(Eigen::Vector3d(0, config.max_speed, 0)));
    EXPECT_TRUE(axis.w_D.isApprox(Eigen::Vector3d(0, 0, -config.max_spin)));
    const Rates diagonal = ratesOf({1, -1, 1, 1, 1, 1}, false, config);
    EXPECT_NEAR(diagonal.v_D.norm(), config.max_speed, 1e-12);
    EXPECT_NEAR(diagonal.w_D.norm(), config.max_spin, 1e-12);
}

TEST(Rates, FineModeAndWorkspaceScaleSlowTheHandleDown) {
    const RateConfig config{.fine_share = 0.2, .hand_space = HandSpace(4)};
    const Rates rates = ratesOf({1, 0, 0, 1, 0, 0}, true, config);
    EXPECT_NEAR(rates.v_D.x(), 0.2 * config.max_speed / 4, 1e-12);
    EXPECT_NEAR(rates.w_D.x(), 0.2 * config.max_spin, 1e-12);
}

TEST(Rates, AreInTheUsersAxes) {
    RateConfig config;
    config.R_DU = expRotation({0, 0, std::numbers::pi / 2});
    const Rates rates = ratesOf({1, 0, 0, 0, 1, 0}, false, config);
    EXPECT_TRUE(rates.v_D.isApprox(Eigen::Vector3d(0, config.max_speed, 0), 1e-9));
    EXPECT_TRUE(rates.w_D.isApprox(Eigen::Vector3d(-config.max_spin, 0, 0), 1e-9));
}

TEST(RateWish, IntegratesTheRatesExactlyWhereTheHandleFollows) {
    const Rates rates{.v_D = {0.02, -0.01, 0.03}, .w_D = {0.3, 0.5, -0.2}};
    RateWish wish(Pose{}, kLeash);
    for (int i = 0; i < 2500; ++i) wish.advance(1e-3, rates, wish.pose());
    EXPECT_LT((wish.pose().position - 2.5 * rates.v_D).norm(), 1e-9);
    EXPECT_LT(wish.pose().rotation.angularDistance(expRotation(2.5 * rates.w_D)), 1e-9);
}

TEST(RateWish, DoesNotRunAwayFromAHandleThatIsHeld) {
    const Rates rates{.v_D = {0, 0, -0.06}, .w_D = {1, 0, 0}};
    RateWish wish(Pose{}, kLeash);
    double before = 0;
    for (int i = 0; i < 5000; ++i) {
        wish.advance(1e-3, rates, Pose{});
        const double lead = -wish.pose().position.z();
        ASSERT_GE(lead, before);
        ASSERT_LE(lead, kLeash.distance * (1 + 1e-12));
        ASSERT_LE(logRotation(wish.pose().rotation).norm(), kLeash.angle * (1 + 1e-9));
        before = lead;
    }
    EXPECT_GT(before, 0.99 * kLeash.distance);
    // The way back is not slowed, and begins at once.
    wish.advance(1e-3, {.v_D = {0, 0, 0.06}, .w_D = Eigen::Vector3d::Zero()}, Pose{});
    EXPECT_NEAR(-wish.pose().position.z(), before - 60e-6, 1e-12);
}

TEST(RateWish, SlowsOnlyWhatStretchesFarther) {
    RateWish wish({{0, 0, -kLeash.distance}, Eigen::Quaterniond::Identity()}, kLeash);
    wish.advance(1e-3, {.v_D = {0.05, 0, -0.06}, .w_D = Eigen::Vector3d::Zero()}, Pose{});
    EXPECT_NEAR(wish.pose().position.x(), 50e-6, 1e-8);
    EXPECT_GE(wish.pose().position.z(), -kLeash.distance);
}

TEST(RateWish, ComesAlongWhenTheHandleIsCarriedAway) {
    RateWish wish(Pose{}, kLeash);
    const Pose X_DT_handle{{0.1, 0, 0}, expRotation({0, 1, 0})};
    wish.advance(1e-3, {}, X_DT_handle);
    EXPECT_NEAR((wish.pose().position - X_DT_handle.position).norm(), kLeash.distance, 1e-12);
    EXPECT_NEAR(wish.pose().rotation.angularDistance(X_DT_handle.rotation), kLeash.angle, 1e-9);
}

TEST(RateWish, StandsStillForTheRestOfALongPause) {
    RateWish wish(Pose{}, {.distance = 10, .angle = 3});
    wish.advance(100, {.v_D = {0.1, 0, 0}, .w_D = Eigen::Vector3d::Zero()}, Pose{});
    EXPECT_LE(wish.pose().position.x(), 0.1 * 0.05 + 1e-12);
    wish.advance(-1, {.v_D = {0.1, 0, 0}, .w_D = Eigen::Vector3d::Zero()}, Pose{});
    EXPECT_GE(wish.pose().position.x(), 0);
}

}  // namespace
}  // namespace bonemill
