#include "device_daemon/control/device_loop/device_loop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/device_daemon/control/device_loop/loop_rig.h"

namespace bonemill {
namespace {

using test::LoopRig;

TEST(DeviceLoop, SaysNothingBeforeADeviceWasHeard) {
    LoopRig rig;
    rig.device.is_heard = false;
    rig.run(0.1);
    EXPECT_FALSE(rig.has_sample);
    EXPECT_EQ(rig.loop.unheardPeriods(), 0u);
}

TEST(DeviceLoop, TheSampleTellsWhatTheDeviceSays) {
    LoopRig rig;
    rig.device.reading.X_DT = {{0.01, 0.02, 0.03}, expRotation({0.1, 0.2, 0.3})};
    rig.device.reading.v_DT = {0.1, 0, 0.2};
    rig.device.reading.w_DT = {0, 1, 0};
    rig.device.reading.buttons = kButtonRemove;
    rig.step();
    ASSERT_TRUE(rig.has_sample);
    EXPECT_TRUE(isPlausible(rig.sample));
    EXPECT_EQ(rig.sample.stamp_ns, rig.now_ns);
    EXPECT_EQ(rig.sample.p_DT[1], 0.02);
    EXPECT_EQ(rig.sample.q_DT[0], rig.device.reading.X_DT.rotation.w());
    EXPECT_EQ(rig.sample.v_DT[2], 0.2);
    EXPECT_EQ(rig.sample.w_DT[1], 1);
    EXPECT_EQ(rig.sample.buttons, kButtonRemove);
    EXPECT_TRUE(rig.sample.flags & kDeviceFlagCalibrated);
    EXPECT_FALSE(rig.sample.flags & (kDeviceFlagEnabled | kDeviceFlagSimulated));
}

TEST(DeviceLoop, OnlyASimulatedHandHasAScriptThatEnds) {
    for (const bool is_simulated : {false, true}) {
        LoopRig rig;
        if (is_simulated) rig.device.device.abilities |= kAbilitySimulated;
        ++rig.device.version;
        rig.step();
        EXPECT_FALSE(rig.sample.flags & kDeviceFlagScriptEnded);
        rig.device.reading.status |= kStatusScriptEnded;
        rig.step();
        EXPECT_EQ(bool(rig.sample.flags & kDeviceFlagScriptEnded), is_simulated);
    }
}

TEST(DeviceLoop, GivesNoForceBeforeItIsEngaged) {
    LoopRig rig;
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        ASSERT_EQ(rig.force(), 0);
        ASSERT_FALSE(rig.device.order.is_engaged);
    }
    EXPECT_TRUE(rig.device.order.is_wanted);  // but its motors are on, for they may have to carry the arm
    rig.engage();
    EXPECT_NEAR(rig.force(), 10, 1e-9);
    EXPECT_TRUE(rig.device.order.is_engaged);
}

// As with another scene, whose loop is a new one.
TEST(DeviceLoop, AStopOutlivesTheLoopUntilSomebodyResets) {
    LoopRig before;
    before.engage();
    before.device.reading.fault = StopCause::kDeviceFault;
    before.device.reading.fault_code = 7;
    before.step();
    ASSERT_EQ(before.state(), SafetyState::kFault);

    LoopRig rig({}, before.loop.safety().latch());
    rig.engage();
    EXPECT_EQ(rig.state(), SafetyState::kFault);
    EXPECT_EQ(rig.cause(), StopCause::kDeviceFault);
    EXPECT_EQ(rig.sample.fault_code, 7u);
    EXPECT_EQ(rig.force(), 0);
    rig.run(0.2);
    EXPECT_FALSE(rig.loop.blackBox().isFull()) << "that stop is written already";

    rig.server = [](WrenchCommand& c) {
        LoopRig::setForce(c, 10);
        c.reset_orders = 1;
    };
    rig.run(0.1);
    EXPECT_EQ(rig.sample.reset_count, 1u);
    rig.engage();
    EXPECT_EQ(rig.state(), SafetyState::kEngaged);
    EXPECT_EQ(LoopRig({}, rig.loop.safety().latch()).state(), SafetyState::kDisconnected);
    EXPECT_EQ(rig.loop.safety().latch().reset_count, 1u);
}

TEST(DeviceLoop, TheMotorsStayOffWithoutAServer) {
    LoopRig rig;
    rig.is_server_there = false;
    rig.run(0.1);
    EXPECT_FALSE(rig.device.order.is_wanted);
}

TEST(DeviceLoop, ForgedCommandsStayWithinTheDeviceAndItsRates) {
    LoopRig rig;
    rig.engage();
    double before = rig.force();
    for (int i = 0; i < 3000; ++i) {
        const double size = i % 2 ? 300 : -300;
        rig.server = [&](WrenchCommand& c) {
            LoopRig::setForce(c, i < 1000 ? 300 : size);
            c.t_hand_D[0] = i < 1000 ? 5.7 : -size;
        };
        rig.step();
        const Wrench given = rig.device.order.wrench_hand_D;
        ASSERT_LE(given.force.norm(), 20 * (1 + 1e-12));
        ASSERT_LE(given.torque.norm(), 0.5 * (1 + 1e-12));
        ASSERT_LE(std::abs(given.force.norm() - before), 3 + 1e-9);
        before = given.force.norm();
    }
    EXPECT_TRUE(rig.sample.flags & kDeviceFlagForceLimited);
}

TEST(DeviceLoop, AnotherDeviceBringsItsOwnLimits) {
    LoopRig rig;
    rig.server = [](WrenchCommand& c) {
        LoopRig::setForce(c, 18);
        c.t_hand_D[0] = 0.3;
    };
    rig.engage();
    EXPECT_NEAR(rig.force(), 18, 1e-9);
    rig.device.device.max_force = 3.3;
    rig.device.device.max_torque = 0;
    rig.device.version = 2;
    rig.step();
    EXPECT_LE(rig.force(), 3.3);
    EXPECT_EQ(rig.device.order.wrench_hand_D.torque, Eigen::Vector3d::Zero());
}

// How exactly motors measure their force goes with what they can give, not with what a scene lets them give.
TEST(DeviceLoop, AGentleSceneMakesNoFaultOfWhatAStrongDeviceMeasures) {
    for (const double off : {0.8, 4.0}) {
        DeviceLoopConfig gentle;
        gentle.wrench.max_force = 2;
        LoopRig rig(gentle);
        rig.engage();
        rig.device.reading.has_applied = true;
        rig.device.reading.applied_D.force = {0, off, rig.force()};
        rig.run(0.2);
        EXPECT_EQ(rig.state(), off < 1 ? SafetyState::kEngaged : SafetyState::kFault) << off;
    }
}

TEST(DeviceLoop, OnlyASimulatedDeviceMayLackTheSwitch) {
    LoopRig rig;
    rig.server = [](WrenchCommand& c) { LoopRig::setForce(c, 0); };
    rig.device.device.abilities = kAbilityForce;
    rig.device.version = 2;
    rig.run(0.1);
    EXPECT_EQ(rig.state(), SafetyState::kReady);
    rig.device.device.abilities |= kAbilitySimulated;
    rig.device.version = 3;
    rig.run(0.1);
    EXPECT_EQ(rig.state(), SafetyState::kEngaged);
}

TEST(DeviceLoop, StaleAndFutureStampsAreSilence) {
    for (const int64_t age_ns : {int64_t(21'000'000), int64_t(-21'000'000), INT64_MAX / 2, INT64_MIN / 2}) {
        LoopRig rig;
        rig.engage();
        rig.server = [&](WrenchCommand& c) { c.stamp_ns = rig.now_ns - age_ns; };
        rig.run(0.1);
        EXPECT_EQ(rig.state(), SafetyState::kPaused) << age_ns;
        EXPECT_EQ(rig.force(), 0) << age_ns;
    }
}

TEST(DeviceLoop, ASilentDeviceShowsItsLastPoseWithItsOldStamp) {
    LoopRig rig;
    rig.engage();
    rig.device.reading.v_DT = {0.1, 0, 0};
    rig.step();
    const int64_t last_ns = rig.now_ns;
    rig.device.is_heard = false;
    rig.run(0.1);
    EXPECT_TRUE(rig.has_sample);
    EXPECT_EQ(rig.sample.stamp_ns, last_ns);
    EXPECT_EQ(rig.sample.v_DT[0], 0);
    EXPECT_EQ(SafetyState(rig.sample.state), SafetyState::kDisconnected);
    EXPECT_EQ(rig.loop.unheardPeriods(), 100u);
}

TEST(DeviceLoop, AResetOrderOfTheServerCountsOnce) {
    LoopRig rig;
    rig.command.reset_orders = 7;  // whatever an earlier server has left there
    rig.device.reading.fault = StopCause::kDeviceFault;
    rig.device.clears_fault_on_reset = true;
    rig.run(0.01);
    EXPECT_EQ(rig.state(), SafetyState::kFault);
    rig.command.reset_orders = 8;
    rig.step();
    EXPECT_TRUE(rig.device.order.reset);
    rig.step();
    EXPECT_FALSE(rig.device.order.reset);
    rig.run(0.01);
    EXPECT_EQ(rig.loop.safety().resetCount(), 1u);
    EXPECT_EQ(rig.state(), SafetyState::kReady);
    rig.device.reading.fault = StopCause::kSingularity;
    rig.step();
    rig.device.reading.fault = StopCause::kNone;
    rig.command.reset_orders = 0;  // another server starts, and has ordered nothing
    rig.run(0.5);
    EXPECT_EQ(rig.state(), SafetyState::kProtectiveStop);
}

TEST(DeviceLoop, WhatHasRunAwayIsSwitchedOffAfterItsRamp) {
    LoopRig rig;
    rig.engage();
    rig.device.reading.v_DT = {3, 0, 0};
    rig.run(0.005);
    EXPECT_EQ(rig.state(), SafetyState::kProtectiveStop);
    EXPECT_TRUE(rig.device.order.is_wanted);
    rig.run(0.02);
    EXPECT_FALSE(rig.device.order.is_wanted);
}

TEST(DeviceLoop, ReleaseTakesTheForceAwayByTheRamp) {
    LoopRig rig;
    rig.engage();
    rig.loop.release();
    EXPECT_FALSE(rig.loop.isReleased());
    double before = rig.force();
    for (int i = 0; i < 31; ++i) {
        rig.step();
        EXPECT_LE(rig.force(), before);
        EXPECT_GE(rig.force(), before - 0.52);  // 10 N in 30 ms, at its steepest 1.5 times that
        before = rig.force();
    }
    EXPECT_EQ(rig.force(), 0);
    EXPECT_FALSE(rig.device.order.is_wanted);
    rig.run(0.01);
    EXPECT_TRUE(rig.loop.isReleased());
}

}  // namespace
}  // namespace bonemill
