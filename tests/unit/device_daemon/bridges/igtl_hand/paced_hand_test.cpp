// A hand that is told seldom and unevenly moves evenly, and is lost in time.
#include "device_daemon/bridges/igtl_hand/paced_hand.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "device_daemon/bridges/igtl_hand/igtl_hand.h"

namespace bonemill::bridge {
namespace {

constexpr int64_t kMs = kNsPerMillisecond;

HeardPose poseAt(double x_m, int64_t heard_ns, uint64_t count, uint64_t hold = 1) {
    HeardPose heard;
    heard.p_D = {x_m, 0, 0};
    heard.heard_ns = heard_ns;
    heard.count = count;
    heard.hold = hold;
    heard.is_held = true;
    return heard;
}

TEST(PacedHand, WaitsForTheFirstPoseWithoutBeingLost) {
    PacedHand hand;
    for (int64_t ms = 1; ms < 5000; ++ms) {
        const ArmReading reading = hand.step({}, ms * kMs);
        ASSERT_TRUE(reading.is_valid);
        ASSERT_FALSE(reading.is_homed || reading.is_powered);
    }
    const ArmReading reading = hand.step(poseAt(0.05, 5000 * kMs, 1), 5000 * kMs);
    EXPECT_TRUE(reading.is_valid && reading.is_homed && reading.is_powered);
    EXPECT_EQ(reading.X_DT.position.x(), 0.05) << "it begins there, and does not move there";
}

// 0.3 m/s, told at 100 Hz give or take 4 ms; each step of 1 ms is near 0.3 mm, and it is late by one pose.
TEST(PacedHand, MovesEvenlyBetweenPosesThatComeUnevenly) {
    PacedHand hand;
    constexpr double kSpeed = 0.3;
    HeardPose heard;
    double before = 0, fastest = 0, latest = 0;
    int64_t due_ms = 0;
    for (int64_t ms = 0; ms < 3000; ++ms) {
        if (ms >= due_ms) {
            heard = poseAt(kSpeed * double(due_ms) * 1e-3, ms * kMs, heard.count + 1);
            due_ms = (due_ms / 10 + 1) * 10 + (heard.count % 3 == 0 ? 4 : 0);
        }
        const double x = hand.step(heard, ms * kMs).X_DT.position.x();
        if (ms > 500) {
            fastest = std::max(fastest, (x - before) * 1000);
            latest = std::max(latest, double(ms) * 1e-3 - x / kSpeed);
            EXPECT_GE(x, before) << "never back";
        }
        before = x;
    }
    EXPECT_LT(fastest, 2 * kSpeed);
    EXPECT_LT(latest, 0.026);
}

TEST(PacedHand, SilenceIsALossAndThenAWaitForTheNextHand) {
    PacedHand hand;
    HeardPose heard = poseAt(0.01, 0, 1);
    EXPECT_TRUE(hand.step(heard, 20 * kMs).is_valid);
    EXPECT_FALSE(hand.step(heard, 26 * kMs).is_valid);
    EXPECT_FALSE(hand.step(heard, 999 * kMs).is_valid);
    ArmReading reading = hand.step(heard, 1001 * kMs);
    EXPECT_TRUE(reading.is_valid);
    EXPECT_FALSE(reading.is_homed);
    heard.is_held = false;
    EXPECT_FALSE(hand.step(heard, 1002 * kMs).is_homed);
    reading = hand.step(poseAt(-0.05, 1100 * kMs, 2, 2), 1100 * kMs);
    EXPECT_TRUE(reading.is_homed);
    EXPECT_EQ(reading.X_DT.position.x(), -0.05) << "another hand is where it is";
}

TEST(PacedHand, AHandThatLetsGoIsLostAtOnce) {
    PacedHand hand;
    HeardPose heard = poseAt(0.01, 0, 1);
    EXPECT_TRUE(hand.step(heard, 1 * kMs).is_valid);
    heard.is_held = false;
    EXPECT_FALSE(hand.step(heard, 2 * kMs).is_valid);
}

TEST(IgtlHand, AxesAreARightHandedChoice) {
    EXPECT_EQ(axesOf("x,y,z"), Eigen::Matrix3d::Identity());
    const Eigen::Matrix3d axes = axesOf("-y,x,z");
    EXPECT_EQ(Eigen::Vector3d(axes * Eigen::Vector3d(1, 2, 3)), Eigen::Vector3d(-2, 1, 3));
    for (const char* wrong :
         {"", "x", "x,y", "x,y,z,x", "x,x,z", "y,x,z", "x,y,-z", "a,b,c", "x y z", "--x,y,z"})
        EXPECT_THROW(axesOf(wrong), UserError) << wrong;
}

}  // namespace
}  // namespace bonemill::bridge
