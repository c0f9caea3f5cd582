// A device between two steps of its encoders.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/core/tick/hand_pose.h"

namespace bonemill {
namespace {

constexpr double kReadPeriod = 1e-3, kReadStep = 50e-6;
constexpr HandleDynamics kReadHandle{.mass = 0.1,
                                     .damping = 2,
                                     .inertia = 2e-5,
                                     .angular_damping = 4e-3,
                                     .amplifier_time = 0,
                                     .delay = 0,
                                     .encoder_step = kReadStep,
                                     .encoder_angle = 1e-3};
constexpr HandSpring kReadSpring{3000, 0.5, 0};

Pose placedAt(double x) {
    return {{x, 0, 0}, Eigen::Quaterniond::Identity()};
}
Pose readAt(double x) {
    return placedAt(std::round(x / kReadStep) * kReadStep);
}

TEST(HandEstimate, NeverLeavesWhatTheReadingSays) {
    HandEstimate estimate(kReadHandle, kReadSpring, {}, kReadPeriod);
    for (int n = 0; n < 3000; ++n) {
        const double x = 5e-3 * std::sin(0.02 * n) + 1e-4 * std::sin(0.7 * n);
        const Pose reading = readAt(x), pose = estimate.take(reading);
        EXPECT_LE(std::abs(pose.position.x() - reading.position.x()), kReadStep / 2 * (1 + 1e-9));
        estimate.sent({{std::sin(0.3 * n), 0, 0}, {0, 0, 0}});
    }
}

TEST(HandEstimate, ADeviceThatFallsIsFollowedBetweenTheSteps) {
    HandEstimate estimate(kReadHandle, kReadSpring, {}, kReadPeriod);
    double error = 0, raw = 0, x = 0, v = 0;
    for (int n = 0; n < 4000; ++n) {
        const double drift = 0.02;  // N against 2 N·s/m: 10 mm/s, five ticks a step
        const Pose pose = estimate.take(readAt(x));
        if (n > 2000) {
            error += std::pow(pose.position.x() - x, 2);
            raw += std::pow(readAt(x).position.x() - x, 2);
        }
        estimate.sent({});
        v = (v + kReadPeriod * drift / kReadHandle.mass) /
            (1 + kReadPeriod * kReadHandle.damping / kReadHandle.mass);
        x += kReadPeriod * v;
    }
    EXPECT_LT(error, raw / 4);
}

TEST(HandEstimate, TakesTheWrenchWhenItActs) {
    for (const int delay : {0, 1, 3}) {
        HandleDynamics handle = kReadHandle;
        handle.delay = delay * kReadPeriod;
        HandEstimate estimate(handle, kReadSpring, {}, kReadPeriod);
        estimate.take(placedAt(0));
        estimate.sent({{1, 0, 0}, {0, 0, 0}});
        for (int n = 0; n < delay; ++n) {
            EXPECT_EQ(estimate.take(placedAt(0)).position.x(), 0);
            estimate.sent({});
        }
        EXPECT_GT(estimate.take(placedAt(0)).position.x(), 0) << delay;
    }
}

TEST(HandEstimate, AJumpIsBelieved) {
    HandEstimate estimate(kReadHandle, kReadSpring, {}, kReadPeriod);
    estimate.take(placedAt(0));
    EXPECT_EQ(estimate.take(placedAt(0.05)).position.x(), 0.05);
}

TEST(HandEstimate, WithoutWordOfADeviceTheReadingComesBack) {
    HandleDynamics no_encoders = kReadHandle;
    no_encoders.encoder_step = no_encoders.encoder_angle = 0;
    HandEstimate idle, ideal(no_encoders, kReadSpring, {}, kReadPeriod);
    for (const double x : {0.0, 1e-6, 0.3}) {
        EXPECT_EQ(idle.take(placedAt(x)).position.x(), x);
        EXPECT_EQ(ideal.take(placedAt(x)).position.x(), x);
    }
}

}  // namespace
}  // namespace bonemill
