#include <gtest/gtest.h>

#include <limits>

#include "device_daemon/ares/driver/udp_device.h"
#include "tests/unit/device_daemon/ares/driver/wire_controller.h"

namespace bonemill {
namespace {

using wire::DriveState;

wire::Describe jointDescription() {
    wire::Describe d = test::testDescription();
    d.max_actuator_force = 40;
    d.stroke = 0.15;
    return d;
}

class UdpJointDeviceTest : public testing::Test {
  protected:
    bool runUntil(const std::function<bool()>& condition) {
        return test::takeTurns(
            [&] {
                device.waitForSample(0);
                is_heard = device.readJoints(1e-3, reading);
                device.applyForces(order);
            },
            [&] { controller.period(); }, condition);
    }
    const wire::ControllerSession<wire::JointPackets>& session() { return controller.link.session(); }

    test::WireController<wire::JointPackets> controller{jointDescription()};
    UdpJointDevice device{{.controller = controller.link.local()}};
    JointReading reading;
    JointOrder order;
    bool is_heard = false;
};

TEST_F(UdpJointDeviceTest, KnowsNothingBeforeAControllerAnswers) {
    UdpJointDevice alone({.controller = {wire::kLoopback, 9}});
    EXPECT_FALSE(alone.waitForSample(0));
    EXPECT_FALSE(alone.readJoints(0, reading));
    EXPECT_EQ(alone.description(), nullptr);
    alone.applyForces(order);
}

TEST_F(UdpJointDeviceTest, ReadsWhatTheControllerSays) {
    controller.state.inputs |= wire::kInputEnabled | (kButtonAdd << wire::kFirstButtonInput);
    for (int i = 0; i < 6; ++i) {
        controller.state.q[i] = 0.01 * i;
        controller.state.qd[i] = 0.5f * float(i);
        controller.state.force[i] = 2.0f * float(i);
        controller.state.temperature_dc[i] = 500;
    }
    const int64_t before_ns = monotonicNowNs();
    ASSERT_TRUE(runUntil([&] { return is_heard && (reading.status & kStatusPowered); }));
    EXPECT_GE(reading.taken_ns, before_ns);
    EXPECT_LE(reading.taken_ns, monotonicNowNs());
    EXPECT_EQ(reading.q[5], 0.05);
    EXPECT_EQ(reading.q_dot[4], 2);
    EXPECT_EQ(reading.forces[3], 6);
    EXPECT_EQ(reading.buttons, uint32_t(kButtonAdd));
    EXPECT_EQ(reading.status, kStatusPowered | kStatusCalibrated | kStatusEnabled);
    EXPECT_EQ(reading.fault, StopCause::kNone);
    EXPECT_EQ(reading.load, 0.5);
    EXPECT_EQ(device.description()->max_actuator_force, 40);
    EXPECT_EQ(device.descriptionCount(), 1u);
}

TEST_F(UdpJointDeviceTest, ANumberThatIsNoneIsAFaultOnce) {
    ASSERT_TRUE(runUntil([&] { return is_heard && (reading.status & kStatusPowered); }));
    controller.state.force[3] = std::numeric_limits<float>::infinity();
    controller.period();
    controller.state.force[3] = 0;
    controller.period();
    device.waitForSample(0);
    EXPECT_FALSE(device.readJoints(1e-3, reading));
    EXPECT_EQ(reading.fault, StopCause::kImplausiblePose);
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    EXPECT_EQ(reading.fault, StopCause::kNone);
}

TEST_F(UdpJointDeviceTest, SwitchesOnWhenWantedAndOffAgain) {
    ASSERT_TRUE(runUntil([&] { return is_heard && (reading.status & kStatusPowered); }));
    EXPECT_EQ(session().drive().state(), DriveState::kSwitchOnDisabled);
    order = {.forces = Vector6d::Constant(3), .is_wanted = true};
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusDriving); }));
    ASSERT_TRUE(session().commandInForce(monotonicNowNs()));
    EXPECT_EQ(session().newestCommand().force[2], 3);
    EXPECT_EQ(session().newestCommand().flags, 0u);
    order.is_engaged = true;
    ASSERT_TRUE(runUntil([&] { return bool(session().newestCommand().flags & wire::kCommandEngaged); }));
    order.is_wanted = false;
    order.is_engaged = false;
    ASSERT_TRUE(runUntil([&] { return !(reading.status & kStatusDriving); }));
    EXPECT_EQ(session().commandInForce(monotonicNowNs()), nullptr);
    EXPECT_EQ(session().newestCommand().force[2], 0);
}

TEST_F(UdpJointDeviceTest, HomesFirst) {
    controller.state.inputs = wire::kInputChainClosed;
    order.is_wanted = true;
    ASSERT_TRUE(runUntil([&] {
        return session().newestCommand().mode == wire::kModeHoming &&
               session().drive().state() == DriveState::kOperationEnabled;
    }));
    EXPECT_EQ(session().commandInForce(monotonicNowNs()), nullptr) << "no force while it homes";
    controller.state.inputs |= wire::kInputHoming;
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusHoming); }));
    EXPECT_FALSE(reading.status & kStatusCalibrated);
    controller.state.inputs = wire::kInputChainClosed | wire::kInputHomed;
    ASSERT_TRUE(runUntil([&] { return session().commandInForce(monotonicNowNs()) != nullptr; }));
}

TEST_F(UdpJointDeviceTest, NamesFaultsAndResetsThem) {
    const std::pair<uint32_t, StopCause> cases[] = {
        {wire::kFaultEncoder, StopCause::kDeviceFault},
        {wire::kFaultAmplifier, StopCause::kDeviceFault},
        {wire::kFaultOverSpeed, StopCause::kSpeed},
        {wire::kFaultOverTemperature, StopCause::kOverTemperature},
        {wire::kFaultEmergencyStop, StopCause::kEmergencyStop},
        {wire::kFaultWatchdog, StopCause::kDeviceLost},
        {1u << 30, StopCause::kDeviceFault}};
    for (const auto& [fault, cause] : cases) {
        order = {.is_wanted = true};
        ASSERT_TRUE(
            runUntil([&] { return reading.status & kStatusDriving && reading.fault == StopCause::kNone; }));
        controller.faults = fault;
        ASSERT_TRUE(runUntil([&] { return reading.fault != StopCause::kNone; }));
        EXPECT_EQ(reading.fault, cause) << fault;
        EXPECT_EQ(reading.fault_code, fault);
        EXPECT_FALSE(reading.status & kStatusDriving);
        controller.faults = 0;
        for (int i = 0; i < 5; ++i) runUntil([&, n = 0]() mutable { return ++n == 2; });
        EXPECT_EQ(reading.fault, cause) << "it stays until it is reset";
        order.reset = true;
        runUntil([] { return true; });
        order.reset = false;
        ASSERT_TRUE(runUntil([&] { return reading.fault == StopCause::kNone; }));
    }
}

TEST_F(UdpJointDeviceTest, AGraverFaultDoesNotHideBehindTheFirst) {
    order = {.is_wanted = true};
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusDriving); }));
    controller.faults = wire::kFaultOverTemperature;
    ASSERT_TRUE(runUntil([&] { return reading.fault != StopCause::kNone; }));
    EXPECT_EQ(reading.fault, StopCause::kOverTemperature);
    controller.faults |= wire::kFaultAmplifier;
    ASSERT_TRUE(runUntil([&] { return reading.fault != StopCause::kOverTemperature; }));
    EXPECT_EQ(reading.fault, StopCause::kDeviceFault);
    EXPECT_EQ(reading.fault_code, uint32_t(wire::kFaultOverTemperature)) << "the first one stays latched";
    controller.faults = 0;
    ASSERT_TRUE(runUntil([&] { return reading.fault != StopCause::kDeviceFault; }));
    EXPECT_EQ(reading.fault, StopCause::kOverTemperature);
}

TEST_F(UdpJointDeviceTest, TellsTheFirstOfTwoFaultsFirstAlsoWhenItHearsOfThemTogether) {
    order = {.is_wanted = true};
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusDriving); }));
    controller.faults = wire::kFaultOverTemperature;
    controller.period();
    controller.faults |= wire::kFaultEncoder;
    controller.period();
    for (const StopCause cause : {StopCause::kOverTemperature, StopCause::kDeviceFault}) {
        ASSERT_TRUE(runUntil([] { return true; }));
        EXPECT_EQ(reading.fault, cause);
    }
}

TEST_F(UdpJointDeviceTest, ResetsWhatIsOverOnly) {
    order = {.is_wanted = true};
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusDriving); }));
    controller.faults = wire::kFaultAmplifier;
    ASSERT_TRUE(runUntil([&] { return reading.fault != StopCause::kNone; }));
    order.reset = true;
    runUntil([&, turns = 0]() mutable {
        EXPECT_FALSE(session().newestCommand().controlword & wire::kControlFaultReset);
        order.reset = false;
        return ++turns == 5;
    });
    controller.faults = 0;
    runUntil([turns = 0]() mutable { return ++turns == 50; });
    EXPECT_EQ(reading.fault, StopCause::kDeviceFault) << "the order of then does not count";
    order.reset = true;
    EXPECT_TRUE(runUntil([&] { return reading.fault == StopCause::kNone; }));
}

TEST_F(UdpJointDeviceTest, SaysWhenTheDeviceIsWithoutPowerOrInEmergencyStopOrLeaves) {
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusPowered); }));
    controller.is_powered = false;
    ASSERT_TRUE(runUntil([&] { return !(reading.status & kStatusPowered); }));
    controller.is_powered = true;
    controller.state.inputs |= wire::kInputBrake;
    runUntil([&, n = 0]() mutable { return ++n == 5; });
    EXPECT_FALSE(reading.status & kStatusPowered);
    controller.state.inputs =
        wire::kInputHomed | wire::kInputReset | wire::kInputLeaving | wire::kInputScriptEnded;
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusLeaving); }));
    EXPECT_EQ(reading.status, kStatusPowered | kStatusCalibrated | kStatusEmergencyStop |
                                  kStatusResetPressed | kStatusLeaving | kStatusScriptEnded);
}

}  // namespace
}  // namespace bonemill
