// Each fault of an encoder is found within the time that position_guard.h states, and a sound device raises
// no alarm.
#include <gtest/gtest.h>

#include "tests/unit/device_daemon/ares/ares_device/ares_bench.h"

namespace bonemill {
namespace {

using test::AresBench;
using test::busyPath;
using test::engaged;
using test::kPeriod;

constexpr double kTremor = 50e-6;  // m

// Tells that the device refuses for this cause and counts as uncalibrated.
testing::AssertionResult isRefused(AresBench& bench, StopCause cause) {
    if (bench.step(engaged())) return testing::AssertionFailure() << "it was believed";
    if (bench.reading.fault != cause) return testing::AssertionFailure() << nameOf(bench.reading.fault);
    if (bench.reading.status & kStatusCalibrated) return testing::AssertionFailure() << "it is calibrated";
    return testing::AssertionSuccess();
}

TEST(EncoderFaults, AnOffsetIsFoundInItsFirstPeriod) {
    for (const double offset : {10e-3, -10e-3, 30e-3, -30e-3}) {
        for (int joint = 0; joint < 6; ++joint) {
            AresBench bench(busyPath(kTremor, 1));
            ASSERT_TRUE(bench.run(0.3, engaged()));
            bench.joints.offset[joint] = offset;
            for (int i = 0; i < 100; ++i) ASSERT_TRUE(isRefused(bench, StopCause::kPoseJump)) << joint;
        }
    }
}

TEST(EncoderFaults, AReadingOfZeroIsFoundInItsFirstPeriod) {
    for (int joint = 0; joint < 6; ++joint) {
        AresBench bench(busyPath(kTremor, 1));
        ASSERT_TRUE(bench.run(0.3, engaged()));
        bench.joints.zero_joint = joint;
        EXPECT_TRUE(isRefused(bench, StopCause::kPoseJump)) << joint;
    }
}

struct StuckOutcome {
    double time = 0;  // s until it was found
    double off = 0;   // m, the largest error of the slider until then
};

StuckOutcome stick(int joint, double start) {
    AresBench bench(busyPath(kTremor, 2));
    EXPECT_TRUE(bench.run(start, engaged()));
    bench.joints.stuck_joint = joint;
    const double stuck_at = bench.joints.true_q[joint];
    StuckOutcome outcome;
    while (bench.step(engaged()) && outcome.time < 2) {
        outcome.time += kPeriod;
        outcome.off = std::max(outcome.off, std::abs(bench.joints.true_q[joint] - stuck_at));
    }
    EXPECT_TRUE(isRefused(bench, StopCause::kSensorStuck)) << joint << " at " << start;
    return outcome;
}

// The hand moves at about 50 mm/s, and stands for a moment at every half second.
TEST(EncoderFaults, AJointThatSticksInMotionIsFoundSoon) {
    double latest = 0, worst = 0;
    for (int joint = 0; joint < 6; ++joint) {
        for (const double start : {0.2, 0.7, 1.2, 1.7}) {
            const StuckOutcome outcome = stick(joint, start);
            latest = std::max(latest, outcome.time);
            worst = std::max(worst, outcome.off);
        }
    }
    EXPECT_LT(latest, 0.25);
    EXPECT_LT(worst, 12e-3);
    RecordProperty("latest_s", std::to_string(latest));
    RecordProperty("worst_slider_mm", std::to_string(1e3 * worst));
}

TEST(EncoderFaults, AJointThatSticksAtRestIsFoundOnceTheHandMoves) {
    double latest = 0, worst = 0;
    for (int joint = 0; joint < 6; ++joint) {
        for (const double start : {0.5, 1.0, 1.5}) {
            const StuckOutcome outcome = stick(joint, start);
            latest = std::max(latest, outcome.time);
            worst = std::max(worst, outcome.off);
        }
    }
    EXPECT_LT(latest, 0.5);
    EXPECT_LT(worst, 50e-3);
    RecordProperty("latest_s", std::to_string(latest));
    RecordProperty("worst_slider_mm", std::to_string(1e3 * worst));
}

TEST(EncoderFaults, AFrozenReadingIsFoundWhenThePushChanges) {
    AresBench bench(OperatorPath({}, kTremor));
    ASSERT_TRUE(bench.run(0.5, engaged()));
    bench.joints.is_frozen = true;
    ASSERT_TRUE(bench.run(0.2, engaged()));
    double time = 0;
    while (bench.step(engaged({2, 0, 1})) && time < 5) time += kPeriod;
    EXPECT_TRUE(isRefused(bench, StopCause::kSensorStuck));
    EXPECT_NEAR(time, FrozenCheck::kChangedTime, 0.01);
}

TEST(EncoderFaults, AFrozenReadingIsFoundUnderASteadyPush) {
    AresBench bench(OperatorPath({}, kTremor));
    ASSERT_TRUE(bench.run(0.5, engaged({2, 0, 1})));
    bench.joints.is_frozen = true;
    double time = 0;
    while (bench.step(engaged({2, 0, 1})) && time < 20) time += kPeriod;
    EXPECT_TRUE(isRefused(bench, StopCause::kSensorStuck));
    EXPECT_LT(time, FrozenCheck::kSteadyTime + 0.01);
}

TEST(EncoderFaults, WhatIsNotANumberIsRefusedAndForgiven) {
    AresBench bench(busyPath(kTremor, 1));
    ASSERT_TRUE(bench.run(0.3, engaged()));
    bench.joints.bad_joint = 2;
    for (int i = 0; i < 20; ++i) {
        EXPECT_FALSE(bench.step(engaged()));
        EXPECT_EQ(bench.reading.fault, StopCause::kImplausiblePose);
        EXPECT_EQ(bench.joints.ordered.forces, Vector6d::Zero());
    }
    bench.joints.bad_joint = -1;
    EXPECT_TRUE(bench.step(engaged()));
}

TEST(EncoderFaults, ASilentTimeIsNoJump) {
    AresBench bench(busyPath(kTremor, 1));
    ASSERT_TRUE(bench.run(0.2, engaged()));
    bench.joints.is_silent = true;
    for (int i = 0; i < 50; ++i) {
        EXPECT_FALSE(bench.step(engaged()));
        EXPECT_EQ(bench.reading.fault, StopCause::kNone);
    }
    bench.joints.is_silent = false;
    EXPECT_TRUE(bench.run(0.2, engaged()));
}

// The joints of a controller whose packets come late, or not at all: each holds the joints of one period, and
// the loop's own time between two of them says little.
class PacketJoints final : public JointDevice {
  public:
    explicit PacketJoints(AresEmulator& emulator) : emulator_(emulator) {}

    bool hasClock() const noexcept override { return true; }
    bool waitForSample(int64_t) noexcept override { return true; }
    bool readJoints(double, JointReading& reading) noexcept override {
        reading = newest_;
        return true;
    }
    void applyForces(const JointOrder& order) noexcept override { emulator_.applyForces(order); }

    void come() {
        taken_ns_ += 1'000'000;
        emulator_.readJoints(kPeriod, newest_);
        newest_.taken_ns = taken_ns_;
    }

  private:
    AresEmulator& emulator_;
    JointReading newest_;
    int64_t taken_ns_ = 1;
};

TEST(EncoderFaults, PacketsThatComeLateAreNoJump) {
    // A quick move, 0.3 m/s at its quickest.
    const OperatorPath path({{0, {}, 0}, {0.2, {{0, 0.02, 0.035}, Eigen::Quaterniond::Identity()}, 0}});
    AresEmulator emulator(AresKinematics{}, {}, {}, path);
    emulator.startScenario();
    PacketJoints packets(emulator);
    AresDevice device(packets, {});
    DeviceReading reading;
    double fastest = 0;
    for (int i = 0; i < 100; ++i) {
        // One comes 0.95 ms late, the next one in time, and every other time one does not come at all.
        packets.come();
        ASSERT_TRUE(device.read(1.95e-3, reading)) << nameOf(reading.fault);
        if (i % 2) {
            ASSERT_TRUE(device.read(1e-3, reading));
            packets.come();
        }
        packets.come();
        ASSERT_TRUE(device.read(0.05e-3, reading)) << nameOf(reading.fault) << " at " << i;
        device.write(engaged());
        EXPECT_LT((reading.v_DT - emulator.state().v_DT).norm(), 0.05);
        fastest = std::max(fastest, emulator.state().v_DT.norm());
    }
    EXPECT_GT(fastest, 0.25);
}

class HomedBench : public AresBench {
  public:
    HomedBench() : AresBench(OperatorPath({}, kTremor), configWithHome()) {}

  private:
    static AresDeviceConfig configWithHome() {
        AresDeviceConfig config;
        config.guard.home = HomePlace{};
        return config;
    }
};

TEST(EncoderFaults, AnOffsetFromTheStartIsFoundAtHome) {
    for (int joint = 0; joint < 6; ++joint) {
        for (const double offset : {10e-3, 30e-3, -0.0755}) {  // the last reads 0 in the neutral pose
            HomedBench bench;
            bench.joints.offset[joint] = offset;
            EXPECT_TRUE(isRefused(bench, StopCause::kImplausiblePose));
            DeviceOrder reset = engaged();
            reset.reset = true;
            bench.step(reset);
            EXPECT_TRUE(isRefused(bench, StopCause::kImplausiblePose)) << "a reset cures nothing";
            bench.joints.offset.setZero();
            bench.step(reset);
            EXPECT_TRUE(bench.run(0.1, engaged()));
            EXPECT_TRUE(bench.reading.status & kStatusCalibrated);
        }
    }
}

TEST(EncoderFaults, AfterAJumpAResetIsWorthNothingAwayFromHome) {
    HomedBench bench;
    ASSERT_TRUE(bench.run(0.1, engaged()));
    bench.joints.offset[1] = 10e-3;
    EXPECT_TRUE(isRefused(bench, StopCause::kPoseJump));
    DeviceOrder reset = engaged();
    reset.reset = true;
    bench.step(reset);
    EXPECT_TRUE(isRefused(bench, StopCause::kImplausiblePose));
}

TEST(EncoderFaults, HomingAgainBringsTheBeliefBack) {
    HomedBench bench;
    ASSERT_TRUE(bench.run(0.1, engaged()));
    bench.joints.offset[1] = 10e-3;
    EXPECT_TRUE(isRefused(bench, StopCause::kPoseJump));
    bench.joints.set_status = kStatusHoming;
    EXPECT_TRUE(bench.step({}));
    EXPECT_FALSE(bench.reading.status & kStatusCalibrated);
    EXPECT_EQ(bench.reading.fault, StopCause::kNone);
    bench.joints.set_status = 0;
    bench.joints.offset.setZero();
    EXPECT_TRUE(bench.run(0.1, engaged()));
    EXPECT_TRUE(bench.reading.status & kStatusCalibrated);
}

// A wall at z = 0 resists the hand, which presses on it and moves along it.
DeviceOrder wall(const DeviceReading& reading) {
    const double depth = -reading.X_DT.position.z();
    return engaged({0, 0, depth > 0 ? 1500 * depth : 0});
}

TEST(EncoderFaults, NoAlarmInNormalUse) {
    AresBench bench(busyPath(kTremor, 25));  // 50 s
    for (int i = 0; i < 50'000; ++i) {
        ASSERT_TRUE(bench.step(wall(bench.reading))) << i << ": " << nameOf(bench.reading.fault);
    }
}

// This tremor moves the handle now and then against its friction, which a smaller one does not.
TEST(EncoderFaults, NoAlarmAtRestUnderForceWithTheTremorOfAHand) {
    AresBench bench(OperatorPath({}, 8 * kTremor));
    for (int i = 0; i < 50'000; ++i) {
        const Eigen::Vector3d push(i / 10'000 - 2.0, 0, 1);
        ASSERT_TRUE(bench.step(engaged(push))) << i << ": " << nameOf(bench.reading.fault);
    }
}

// Friction holds the handle, to the last bit, while the push on the hand sways by less than that.
TEST(EncoderFaults, NoAlarmWhileFrictionHoldsTheHandle) {
    AresBench bench(OperatorPath({}, kTremor));
    for (int i = 0; i < 9'000; ++i) {
        ASSERT_TRUE(bench.step(engaged({2 + 0.05 * std::sin(1e-2 * i), 0, 1}))) << i;
    }
}

TEST(EncoderFaults, NoAlarmOfASimulatedHandThatIsPerfectlySmoothOrStill) {
    AresDeviceConfig config;
    config.is_simulated = true;
    config.guard.has_frozen_check = false;
    config.guard.stuck_travel = StuckCheck::kSmoothTravel;
    AresBench bench(busyPath(0, 5), config);  // 10 s of motion, then rest
    for (int i = 0; i < 20'000; ++i) {
        ASSERT_TRUE(bench.step(wall(bench.reading))) << i << ": " << nameOf(bench.reading.fault);
    }
}

}  // namespace
}  // namespace bonemill
