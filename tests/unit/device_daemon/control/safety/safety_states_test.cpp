#include "device_daemon/control/safety/safety_states.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bonemill {
namespace {

constexpr double kStatesDt = 1e-3;
constexpr uint32_t kUsable = kStatusPowered | kStatusCalibrated | kStatusDriving;

// Drives the states period by period; a test changes what comes in.
class States {
  public:
    explicit States(const SafetyConfig& config = {}) : states(config) {
        in.dt = kStatesDt;
        in.is_heard = true;
        in.is_server_there = true;
        in.reading.status = kUsable;
    }
    SafetyState run(double seconds = kStatesDt) {
        for (int i = 0; i < std::lround(seconds / kStatesDt); ++i) {
            in.has_status = in.is_heard || refuses_pose;
            states.update(in);
            steepest = std::max(steepest, last_factor - states.factor());
            last_factor = states.factor();
        }
        return states.state();
    }
    void press() { in.reading.status |= kStatusEnabled; }
    void let() { in.reading.status &= ~uint32_t(kStatusEnabled); }
    SafetyState engage() {
        let();
        run();
        press();
        return run(0.5);
    }
    SafetyState reset() {
        in.is_reset_ordered = true;
        run();
        in.is_reset_ordered = false;
        return run();
    }

    SafetyInput in;
    bool refuses_pose = false;  // the device speaks, but its pose is not believed
    SafetyStates states;
    double last_factor = 0;
    double steepest = 0;  // fall of the factor in one period
};

TEST(SafetyStates, FollowTheDeviceUpToReady) {
    States s;
    s.in.is_heard = false;
    EXPECT_EQ(s.run(), SafetyState::kDisconnected);
    s.in.is_heard = true;
    s.in.reading.status = 0;
    EXPECT_EQ(s.run(), SafetyState::kConnected);
    s.in.reading.status = kStatusPowered | kStatusHoming;
    EXPECT_EQ(s.run(), SafetyState::kHoming);
    s.in.reading.status = kStatusPowered | kStatusCalibrated;
    EXPECT_EQ(s.run(), SafetyState::kReady);
    EXPECT_EQ(s.states.factor(), 0);
}

TEST(SafetyStates, EngageByAFreshPressOnly) {
    States s;
    s.press();  // held from the start
    EXPECT_EQ(s.run(0.2), SafetyState::kReady);
    s.let();
    s.run();
    s.press();
    EXPECT_EQ(s.run(), SafetyState::kEngaged);
    EXPECT_LT(s.states.factor(), 0.01);  // and the force fades in
    s.run(0.15);
    EXPECT_NEAR(s.states.factor(), 0.5, 0.02);
    s.run(0.2);
    EXPECT_EQ(s.states.factor(), 1);
    s.let();
    EXPECT_EQ(s.run(), SafetyState::kReady);
    EXPECT_GT(s.states.factor(), 0.9);  // no kick on the way out
    s.run(0.06);
    EXPECT_EQ(s.states.factor(), 0);
}

TEST(SafetyStates, WithoutASwitchTheDeviceEngagesByItself) {
    States s({.needs_enabling_switch = false});
    s.in.commanded.force = {0, 0, 5};
    EXPECT_EQ(s.run(0.5), SafetyState::kReady);
    EXPECT_TRUE(s.states.waitsForSmallWrench());
    s.in.commanded.force = {0, 0, 0.5};
    EXPECT_EQ(s.run(), SafetyState::kEngaged);
}

TEST(SafetyStates, EngageOnlyWhileTheWrenchIsSmall) {
    const Wrench large[] = {{{0, 0, 1.01}, {0, 0, 0}}, {{0, 0, 0}, {0.021, 0, 0}}, {{NAN, 0, 0}, {0, 0, 0}}};
    for (const Wrench& wrench : large) {
        States s;
        s.in.commanded = wrench;
        EXPECT_EQ(s.engage(), SafetyState::kReady);
        EXPECT_TRUE(s.states.waitsForSmallWrench());
        s.in.commanded = {};
        EXPECT_EQ(s.run(), SafetyState::kEngaged);  // the press is still held
    }
}

TEST(SafetyStates, NothingEngagesWithoutServerOrDrive) {
    States s;
    s.in.is_server_there = false;
    EXPECT_EQ(s.engage(), SafetyState::kReady);
    s.in.is_server_there = true;
    EXPECT_EQ(s.run(0.1), SafetyState::kReady);  // that press was for nobody
    s.in.reading.status &= ~uint32_t(kStatusDriving);
    EXPECT_EQ(s.engage(), SafetyState::kReady);
}

TEST(SafetyStates, ASilentServerPausesUntilItIsBackAndSomebodyPresses) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.is_server_there = false;
    EXPECT_EQ(s.run(), SafetyState::kPaused);
    EXPECT_EQ(s.run(0.06), SafetyState::kPaused);
    EXPECT_EQ(s.states.factor(), 0);
    EXPECT_LT(s.steepest, 0.05);
    s.in.is_server_there = true;
    EXPECT_EQ(s.run(0.5), SafetyState::kPaused);  // the switch was held all the time
    EXPECT_EQ(s.engage(), SafetyState::kEngaged);
}

TEST(SafetyStates, ALostDeviceIsNamedUntilItEngagesAgain) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.is_heard = false;
    s.run(0.015);
    EXPECT_EQ(s.states.state(), SafetyState::kEngaged);  // a hiccup
    s.run(0.01);
    EXPECT_EQ(s.states.state(), SafetyState::kDisconnected);
    EXPECT_EQ(s.states.cause(), StopCause::kDeviceLost);
    s.in.is_heard = true;
    EXPECT_EQ(s.run(0.1), SafetyState::kReady);
    EXPECT_EQ(s.states.cause(), StopCause::kDeviceLost);
    EXPECT_EQ(s.engage(), SafetyState::kEngaged);
    EXPECT_EQ(s.states.cause(), StopCause::kNone);
}

TEST(SafetyStates, ATripHoldsUntilAReset) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.reading.v_DT = {3, 0, 0};
    EXPECT_EQ(s.run(0.005), SafetyState::kProtectiveStop);
    EXPECT_EQ(s.states.cause(), StopCause::kSpeed);
    s.in.reading.v_DT.setZero();
    s.run(0.011);
    EXPECT_EQ(s.states.factor(), 0);
    EXPECT_EQ(s.engage(), SafetyState::kProtectiveStop);  // a press is no reset
    EXPECT_EQ(s.reset(), SafetyState::kReady);
    EXPECT_EQ(s.states.cause(), StopCause::kNone);
    EXPECT_EQ(s.states.resetCount(), 1u);
    EXPECT_EQ(s.run(0.1), SafetyState::kReady);  // and a reset is no press
    EXPECT_EQ(s.engage(), SafetyState::kEngaged);
}

TEST(SafetyStates, TheEmergencyStopTakesTheForceAtOnceAndIsNotResetWhileItIsOpen) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.reading.status |= kStatusEmergencyStop;
    EXPECT_EQ(s.run(), SafetyState::kEmergencyStop);
    EXPECT_EQ(s.states.factor(), 0);
    EXPECT_EQ(s.reset(), SafetyState::kEmergencyStop);
    s.in.reading.status &= ~uint32_t(kStatusEmergencyStop);
    EXPECT_EQ(s.run(0.5), SafetyState::kEmergencyStop);
    EXPECT_EQ(s.reset(), SafetyState::kReady);
}

TEST(SafetyStates, TheFirstCauseStaysAndTheWorstStateHolds) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.reading.v_DT = {3, 0, 0};
    s.run(0.005);
    s.in.reading.fault = StopCause::kDeviceFault;
    s.in.reading.fault_code = 42;
    EXPECT_EQ(s.run(), SafetyState::kFault);
    EXPECT_EQ(s.states.cause(), StopCause::kSpeed);
    s.in.reading.status |= kStatusEmergencyStop;
    EXPECT_EQ(s.run(), SafetyState::kEmergencyStop);
    EXPECT_EQ(s.states.cause(), StopCause::kSpeed);
}

TEST(SafetyStates, TheDeviceIsAskedToClearItsOwnFault) {
    States s;
    s.in.reading.fault = StopCause::kDeviceFault;
    s.in.reading.fault_code = 42;
    EXPECT_EQ(s.run(), SafetyState::kFault);
    EXPECT_EQ(s.states.faultCode(), 42u);
    s.in.is_reset_ordered = true;
    s.run();
    EXPECT_TRUE(s.states.hasReset());
    s.in.is_reset_ordered = false;
    EXPECT_EQ(s.run(0.1), SafetyState::kFault);  // the device still says so
    s.in.reading.fault = StopCause::kNone;
    EXPECT_EQ(s.run(), SafetyState::kReady);  // one reset is enough
    s.in.reading.fault = StopCause::kDeviceFault;
    s.reset();
    s.run(0.4);
    s.in.reading.fault = StopCause::kNone;
    EXPECT_EQ(s.run(0.1), SafetyState::kFault);  // and it does not wait for ever
}

TEST(SafetyStates, ABrokenSensorIsAFaultAlsoWhenNothingCanBeRead) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.is_heard = false;
    s.in.reading.fault = StopCause::kSensorStuck;
    EXPECT_EQ(s.run(), SafetyState::kFault);
    EXPECT_EQ(s.reset(), SafetyState::kFault);
}

TEST(SafetyStates, SwitchesCountAlsoWhenThePoseIsRefused) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.is_heard = false;
    s.refuses_pose = true;
    s.in.reading.fault = StopCause::kSensorStuck;
    s.in.reading.status |= kStatusEmergencyStop;
    EXPECT_EQ(s.run(), SafetyState::kEmergencyStop);
    s.in.reading.status &= ~uint32_t(kStatusEmergencyStop);
    s.in.reading.fault = StopCause::kNone;
    s.in.reading.status |= kStatusResetPressed;
    EXPECT_EQ(s.run(), SafetyState::kReady);
}

TEST(SafetyStates, AMotorThatPushesUntoldIsAFaultInEveryState) {
    for (const bool is_stopped : {false, true}) {
        States s;
        if (is_stopped) {
            s.engage();
            s.in.reading.v_DT = {3, 0, 0};
            s.run(0.005);
            s.in.reading.v_DT.setZero();
        }
        s.in.reading.has_applied = true;
        s.in.reading.applied_D.force = {0, 0, 30};
        EXPECT_EQ(s.run(0.2), SafetyState::kFault) << is_stopped;
    }
}

// An arm that is heavy is held up from the first order on, and its motors need some ms until they do.
TEST(SafetyStates, MotorsThatHaveJustBeenSwitchedOnMayNeedSomeTime) {
    for (const bool was_engaged : {false, true}) {
        States s;
        if (was_engaged) s.engage();
        s.in.reading.status &= ~uint32_t(kStatusDriving);
        s.run(3);
        s.in.reading.status |= kStatusDriving;
        s.in.reading.has_applied = true;
        for (double missing = 20; missing > 0.01; missing *= 0.7) {
            s.in.reading.applied_D.force = {0, 0, -missing};
            ASSERT_EQ(s.run(), SafetyState::kReady) << missing << " N, " << nameOf(s.states.cause());
        }
        s.in.reading.applied_D.force = {0, 0, -20};
        EXPECT_EQ(s.run(0.2), SafetyState::kFault);
    }
}

TEST(SafetyStates, AfterAPauseOfTheLoopTheForceStillFadesIn) {
    States s;
    s.run();
    s.press();
    s.run();
    s.in.dt = 1;
    s.states.update(s.in);
    EXPECT_LT(s.states.factor(), 0.01);
}

TEST(SafetyStates, AResetButtonCountsByItsPress) {
    States s;
    s.in.reading.status |= kStatusResetPressed;  // held down, perhaps jammed
    s.run();
    s.in.reading.fault = StopCause::kSingularity;
    s.run();
    s.in.reading.fault = StopCause::kNone;
    EXPECT_EQ(s.run(0.5), SafetyState::kProtectiveStop);
    s.in.reading.status &= ~uint32_t(kStatusResetPressed);
    s.run();
    s.in.reading.status |= kStatusResetPressed;
    EXPECT_EQ(s.run(2 * kStatesDt), SafetyState::kReady);
}

TEST(SafetyStates, HotMotorsAreSparedBeforeTheyStop) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    s.in.reading.load = 0.9;
    s.run(SafetyStates::kWarmTime);
    EXPECT_NEAR(s.states.factor(), 0.65, 1e-9);
    s.in.reading.load = 1.0;
    EXPECT_EQ(s.run(), SafetyState::kProtectiveStop);
    EXPECT_EQ(s.states.cause(), StopCause::kOverTemperature);
}

// A thermometer that flickers, or lies once, must not be felt.
TEST(SafetyStates, AThermometerThatFlickersMakesNoSteps) {
    States s;
    ASSERT_EQ(s.engage(), SafetyState::kEngaged);
    double before = s.states.factor();
    for (int i = 0; i < 3000; ++i) {
        s.in.reading.load = i % 500 == 0 ? 0.99 : 0.88 + 0.02 * (i % 2);
        s.run();
        ASSERT_LE(std::abs(s.states.factor() - before), kStatesDt / SafetyStates::kWarmTime + 1e-12) << i;
        before = s.states.factor();
    }
    EXPECT_NEAR(before, 0.65, 0.08);
}

}  // namespace
}  // namespace bonemill
