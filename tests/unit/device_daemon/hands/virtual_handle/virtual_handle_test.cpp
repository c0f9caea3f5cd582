// The virtual handle follows wishes that come like those of a mouse, presses no harder than its hand is
// strong, and holds still against a wall with one period of delay.
#include "device_daemon/hands/virtual_handle/virtual_handle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bonemill {
namespace {

constexpr double kPeriod = 1e-3;       // s, of the loop
constexpr double kCoupling = 3000;     // N/m: what a rigid bone feels like through the default coupling
constexpr double kTurnCoupling = 0.5;  // N·m/rad, likewise

Pose at(const Eigen::Vector3d& p, const Eigen::Vector3d& turn = Eigen::Vector3d::Zero()) {
    return {p, expRotation(turn)};
}

// The wall resists z < 0, and what turns the handle about x; it answers the pose of the period before.
class WalledHandle {
  public:
    explicit WalledHandle(double wall = kCoupling, double turn_wall = kTurnCoupling)
        : wall_(wall), turn_wall_(turn_wall) {}

    void step(double elapsed = kPeriod) {
        handle.advance(elapsed, answer);
        answer = {};
        const double z = handle.pose().position.z();
        if (z < 0) answer.force.z() = -wall_ * z;
        answer.torque.x() = -turn_wall_ * logRotation(handle.pose().rotation).x();
    }
    void run(double seconds) {
        for (int i = 0; i < std::lround(seconds / kPeriod); ++i) step();
    }

    VirtualHandle handle{at({0, 0, 0.005})};
    Wrench answer;

  private:
    double wall_, turn_wall_;
};

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double x) { low = std::min(low, x), high = std::max(high, x); }
    double width() const { return high - low; }
};

TEST(VirtualHandle, FollowsTheWishInFreeSpace) {
    VirtualHandle handle{Pose{}};
    handle.want(at({0.02, -0.01, 0.03}, {0.3, 0, -0.5}));
    for (int i = 0; i < 1500; ++i) handle.advance(kPeriod, {});
    EXPECT_LT((handle.pose().position - Eigen::Vector3d(0.02, -0.01, 0.03)).norm(), 1e-6);
    EXPECT_LT(handle.pose().rotation.angularDistance(expRotation({0.3, 0, -0.5})), 1e-5);
    EXPECT_LT(handle.v_DT().norm(), 1e-6);
}

TEST(VirtualHandle, PressesHarderTheFartherTheWishIsInsideAndNeverAboveItsStrength) {
    const VirtualHand hand;
    double before = 0;
    for (const double depth : {0.001, 0.004, 0.01, 0.02, 0.1, 0.4}) {
        WalledHandle walled;
        walled.handle.want(at({0, 0, -depth}));
        walled.run(3);
        const double pressing = walled.answer.force.z();
        const double spring = hand.stiffness * depth * kCoupling / (hand.stiffness + kCoupling);
        EXPECT_NEAR(pressing, std::min(spring, hand.max_force), 0.01) << depth;
        EXPECT_GE(pressing, before - 1e-6);
        before = pressing;
    }
    EXPECT_NEAR(before, hand.max_force, 1e-3);
    EXPECT_LT(hand.max_force, 10);
}

TEST(VirtualHandle, HoldsStillAgainstAWallWithOnePeriodOfDelay) {
    for (const double wall : {kCoupling, VirtualHandle::kMaxStiffness})
        for (const double depth : {0.0005, 0.003, 0.02, 0.3}) {
            WalledHandle walled(wall, VirtualHandle::kMaxRotationStiffness);
            walled.handle.want(at({0.001, 0, -depth}, {0.2, 0, 0}));
            walled.run(2.5);
            Range force, torque;
            for (int i = 0; i < 1000; ++i) {
                walled.step();
                force.add(walled.answer.force.z());
                torque.add(walled.answer.torque.x());
            }
            EXPECT_LT(force.width(), 5e-3) << wall << " N/m, " << depth << " m";
            EXPECT_LT(torque.width(), 5e-5) << wall << " N/m, " << depth << " m";
        }
}

TEST(VirtualHandle, AnImpactDiesAway) {
    WalledHandle walled;
    walled.handle.want(at({0, 0, -0.2}));
    Range late;
    double peak = 0;
    for (int i = 0; i < 1500; ++i) {
        walled.step();
        peak = std::max(peak, walled.answer.force.z());
        if (i > 700) late.add(walled.answer.force.z());
    }
    EXPECT_LT(peak, 2 * VirtualHand{}.max_force);
    EXPECT_LT(late.width(), 0.01);
}

TEST(VirtualHandle, WishesOfAMouseMakeNoStairs) {
    std::mt19937 random(7);
    for (const double per_second : {30.0, 60.0}) {
        std::uniform_real_distribution<double> jitter(0.6, 1.4);
        constexpr double kSpeed = 0.03;  // m/s
        VirtualHandle handle{Pose{}};
        double next_wish = 0, fastest_change = 0;
        Range speed;
        Eigen::Vector3d v_before = Eigen::Vector3d::Zero();
        for (int i = 0; i < 3000; ++i) {
            const double t = i * kPeriod;
            if (t >= next_wish) {
                handle.want(at({kSpeed * t, 0, 0}));
                next_wish += jitter(random) / per_second;
            }
            handle.advance(kPeriod, {});
            fastest_change = std::max(fastest_change, (handle.v_DT() - v_before).norm() / kPeriod);
            v_before = handle.v_DT();
            if (t > 1) speed.add(handle.v_DT().x());
        }
        EXPECT_LT(fastest_change, 0.8) << per_second;  // m/s²; stairs of 1 mm would make above 100
        EXPECT_NEAR((speed.low + speed.high) / 2, kSpeed, 0.1 * kSpeed) << per_second;
        EXPECT_LT(speed.width(), 0.4 * kSpeed) << per_second;  // stairs: from nothing to many times as fast
    }
}

TEST(VirtualHandle, LettingGoStaysWhereItIsAndStopsPressing) {
    WalledHandle walled;
    walled.handle.want(at({0, 0, -0.1}));
    walled.run(2);
    const Eigen::Vector3d before = walled.handle.pose().position;
    walled.handle.letGo();
    walled.run(2);
    EXPECT_LT((walled.handle.pose().position - before).norm(), 0.003);
    EXPECT_LT(walled.answer.force.z(), 2);
}

TEST(VirtualHandle, BadInputMovesNothingBad) {
    VirtualHandle handle{Pose{}};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    handle.advance(nan, {});
    handle.advance(-1, {});
    handle.advance(kPeriod, {Eigen::Vector3d(nan, 0, 0), Eigen::Vector3d::Zero()});
    EXPECT_TRUE(handle.pose().isFinite());
    handle.want(at({100, 0, 0}));
    for (int i = 0; i < 5000; ++i)
        handle.advance(kPeriod, {Eigen::Vector3d(0, 1000, 0), Eigen::Vector3d(0, 5, 0)});
    EXPECT_TRUE(handle.pose().isFinite());
    EXPECT_LE(handle.pose().position.norm(), VirtualHandle::kReach * (1 + 1e-9));
    const Pose before = handle.pose();
    handle.advance(3600, {});
    EXPECT_LT((handle.pose().position - before.position).norm(), 0.1) << "a long pause is mostly skipped";
}

}  // namespace
}  // namespace bonemill
