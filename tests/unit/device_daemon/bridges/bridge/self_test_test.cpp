#include "device_daemon/bridges/bridge/self_test.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace bonemill::bridge {
namespace {

ArmReading wellArm() {
    ArmReading reading;
    reading.is_valid = reading.is_homed = reading.is_powered = true;
    return reading;
}

// Runs it to its end and returns the largest force.
double drive(SelfTest& test, const ArmReading& reading) {
    double largest = 0;
    for (int64_t now_ns = kPeriodNs; !test.hasEnded() && now_ns < 10 * kNsPerSecond; now_ns += kPeriodNs)
        largest = std::max(largest, test.step(reading, now_ns).wrench_D.force.norm());
    return largest;
}

ArmDescription strongArm() {
    ArmDescription arm;
    arm.max_force = 12;
    return arm;
}

TEST(SelfTest, MeasuresAndGivesNoForceUnlessAsked) {
    SelfTest test(strongArm(), 0.5, false);
    EXPECT_EQ(drive(test, wellArm()), 0);
    EXPECT_FALSE(test.step(wellArm(), 11 * kNsPerSecond).is_driving);
    EXPECT_EQ(test.lines().front(), "passed");
}

TEST(SelfTest, TheRampGoesToHalfANewtonAndBack) {
    SelfTest test(strongArm(), 0.5, true);
    EXPECT_NEAR(drive(test, wellArm()), SelfTest::kRampForce, 1e-3);
    EXPECT_NEAR(test.step(wellArm(), 12 * kNsPerSecond).wrench_D.force.norm(), 0, 1e-12);
    EXPECT_EQ(test.lines().front(), "passed");
}

TEST(SelfTest, AnArmThatIsNotReadyIsNotPushed) {
    ArmReading reading = wellArm();
    reading.is_homed = false;
    SelfTest test(strongArm(), 0.5, true);
    EXPECT_EQ(drive(test, reading), 0);
    EXPECT_TRUE(test.lines().front().starts_with("failed: the arm was not ready"));
}

TEST(SelfTest, SaysWhatFailed) {
    ArmReading reading = wellArm();
    reading.is_valid = false;
    SelfTest silent(strongArm(), 0.1, false);
    drive(silent, reading);
    EXPECT_TRUE(silent.lines().front().starts_with("failed: the arm did not answer"));
    SelfTest early(strongArm(), 5, false);
    early.step(wellArm(), kPeriodNs);
    early.leave();
    EXPECT_TRUE(early.lines().front().starts_with("failed: ended before"));
}

}  // namespace
}  // namespace bonemill::bridge
