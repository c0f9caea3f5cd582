#include "device_daemon/ares/driver/udp_pose_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/device_daemon/ares/driver/wire_controller.h"

namespace bonemill {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

class UdpPoseDeviceTest : public testing::Test {
  protected:
    UdpPoseDeviceTest() {
        controller.state.q_DT[0] = 1;
        for (float& f : controller.state.applied) f = kMissing;
    }
    bool runUntil(const std::function<bool()>& condition) {
        return test::takeTurns(
            [&] {
                device.waitForSample(0);
                is_heard = device.read(1e-3, reading);
                device.write(order);
            },
            [&] { controller.period(); }, condition);
    }

    test::WireController<wire::PosePackets> controller{test::testDescription()};
    UdpPoseDevice device{{.controller = controller.link.local()}};
    DeviceReading reading;
    DeviceOrder order;
    bool is_heard = false;
};

TEST_F(UdpPoseDeviceTest, SaysWhatTheBridgeDescribes) {
    EXPECT_EQ(device.capabilities().max_force, 0);
    EXPECT_EQ(device.capabilitiesVersion(), 1u);
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    EXPECT_STREQ(device.capabilities().name, "test device");
    EXPECT_EQ(device.capabilities().kind, 5u);
    EXPECT_EQ(device.capabilities().max_force, 5);
    EXPECT_TRUE(isPlausible(device.capabilities()));
    EXPECT_EQ(device.capabilitiesVersion(), 2u);
}

TEST_F(UdpPoseDeviceTest, ReadsPoseMotionAndForce) {
    wire::PoseState& state = controller.state;
    state.p_DT[1] = 0.02;
    state.q_DT[0] = state.q_DT[3] = std::sqrt(0.5);
    state.v_DT[0] = 0.25f;
    state.w_DT[2] = 1.5f;
    state.load = 0.75f;
    state.fault_code = 77;
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    EXPECT_EQ(reading.X_DT.position.y(), 0.02);
    EXPECT_NEAR(logRotation(reading.X_DT.rotation).z(), std::acos(0.0), 1e-12);
    EXPECT_EQ(reading.v_DT.x(), 0.25);
    EXPECT_EQ(reading.w_DT.z(), 1.5);
    EXPECT_EQ(reading.load, 0.75);
    EXPECT_EQ(reading.fault_code, 77u);
    EXPECT_FALSE(reading.has_applied);
    for (int i = 0; i < 6; ++i) state.applied[i] = float(i);
    ASSERT_TRUE(runUntil([&] { return reading.has_applied; }));
    EXPECT_EQ(reading.applied_D.force.z(), 2);
    EXPECT_EQ(reading.applied_D.torque.x(), 3);
}

TEST_F(UdpPoseDeviceTest, BelievesNoPoseThatIsNone) {
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    controller.state.q_DT[0] = 0.99;
    ASSERT_TRUE(runUntil([&] { return !is_heard; }));
    controller.state.q_DT[0] = 1;
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    controller.state.p_DT[2] = 11;
    ASSERT_TRUE(runUntil([&] { return !is_heard; }));
}

TEST_F(UdpPoseDeviceTest, APoseThatIsNoneHidesNeitherStatusNorFault) {
    ASSERT_TRUE(runUntil([&] { return is_heard && (reading.status & kStatusPowered); }));
    controller.state.q_DT[0] = 0.99;
    controller.state.p_DT[0] = 0.25;
    ASSERT_TRUE(runUntil([&] { return reading.fault != StopCause::kNone; }));
    EXPECT_FALSE(is_heard);
    EXPECT_EQ(reading.fault, StopCause::kImplausiblePose);
    EXPECT_EQ(reading.X_DT.position.norm(), 0);
    controller.state.inputs = wire::kInputHomed | wire::kInputReset | (kButtonAdd << wire::kFirstButtonInput);
    controller.state.fault_code = 77;
    controller.faults = wire::kFaultAmplifier;
    ASSERT_TRUE(runUntil([&] { return reading.fault == StopCause::kDeviceFault; }));
    EXPECT_FALSE(is_heard);
    EXPECT_EQ(reading.fault_code, 77u);
    EXPECT_TRUE(reading.status & kStatusEmergencyStop);
    EXPECT_TRUE(reading.status & kStatusResetPressed);
    EXPECT_EQ(reading.buttons, uint32_t(kButtonAdd));
}

TEST_F(UdpPoseDeviceTest, ANumberThatIsNoneIsAFaultOnce) {
    ASSERT_TRUE(runUntil([&] { return is_heard && (reading.status & kStatusPowered); }));
    const double good = controller.state.p_DT[1];
    controller.state.p_DT[1] = std::nan("");
    controller.period();
    controller.state.p_DT[1] = good;
    controller.period();  // the good one right behind it does not hide it
    device.waitForSample(0);
    EXPECT_FALSE(device.read(1e-3, reading));
    EXPECT_EQ(reading.fault, StopCause::kImplausiblePose);
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    EXPECT_EQ(reading.fault, StopCause::kNone);
}

TEST_F(UdpPoseDeviceTest, APoseThatJumpsIsAFaultUntilAReset) {
    ASSERT_TRUE(runUntil([&] { return is_heard && (reading.status & kStatusPowered); }));
    controller.state.p_DT[0] = 5;  // within a period, or many of a busy machine
    ASSERT_TRUE(runUntil([&] { return !is_heard; }));
    EXPECT_EQ(reading.fault, StopCause::kPoseJump);
    EXPECT_TRUE(reading.status & kStatusPowered);
    EXPECT_EQ(reading.X_DT.position.norm(), 0);
    runUntil([n = 0]() mutable { return ++n == 50; });
    EXPECT_FALSE(is_heard);
    order.reset = true;
    ASSERT_TRUE(runUntil([&] { return is_heard; }));
    EXPECT_EQ(reading.fault, StopCause::kNone);
    EXPECT_EQ(reading.X_DT.position.x(), 5);
}

TEST_F(UdpPoseDeviceTest, GivesTheWrenchOnlyWhenItIsWanted) {
    order.wrench_hand_D = {{1, 2, 3}, {0.1, 0.2, 0.3}};
    ASSERT_TRUE(runUntil([&] { return bool(reading.status & kStatusPowered); }));
    EXPECT_EQ(controller.link.session().newestCommand().wrench[0], 0);
    order.is_wanted = true;
    ASSERT_TRUE(
        runUntil([&] { return controller.link.session().commandInForce(monotonicNowNs()) != nullptr; }));
    EXPECT_EQ(controller.link.session().newestCommand().wrench[1], 2);
    EXPECT_EQ(controller.link.session().newestCommand().wrench[5], 0.3f);
}

TEST_F(UdpPoseDeviceTest, DifferentiatesThePoseOfABridgeThatSaysNoMotion) {
    for (float& v : controller.state.v_DT) v = kMissing;
    for (float& w : controller.state.w_DT) w = kMissing;
    const int64_t start_ns = monotonicNowNs();
    ASSERT_TRUE(test::takeTurns(
        [&] {
            device.waitForSample(0);
            device.read(1e-3, reading);
            device.write(order);
        },
        [&] {  // it moves with 0.1 m/s by the very clock that goes along
            controller.state.p_DT[0] = 0.1 * secondsOfNs(monotonicNowNs() - start_ns);
            controller.period();
        },
        [&] { return reading.v_DT.x() > 0.08; }));
}

TEST(PoseDifferentiator, FollowsASteadyMotionAndSmoothsSteps) {
    constexpr int64_t kStepNs = 1'000'000;
    PoseDifferentiator steady;
    for (int i = 0; i < 50; ++i) {
        steady.take({{0.001 * i, 0, 0}, expRotation({0, 0, 0.002 * i})}, i * kStepNs);
    }
    EXPECT_NEAR(steady.v_DT().x(), 1, 1e-3);
    EXPECT_NEAR(steady.w_DT().z(), 2, 2e-3);

    PoseDifferentiator still;
    still.take({}, 0);
    still.take({{10e-6, 0, 0}, Eigen::Quaterniond::Identity()}, kStepNs);
    EXPECT_NEAR(still.v_DT().x(), 2.7e-3, 1e-4) << "instead of 10 mm/s";
    still.take({{10e-6, 0, 0}, Eigen::Quaterniond::Identity()}, kStepNs);
    EXPECT_NEAR(still.v_DT().x(), 2.7e-3, 1e-4) << "the same sample again says nothing new";
}

TEST(PoseDifferentiator, StartsFromRestAfterAPauseAndWhenTheClockJumps) {
    for (const int64_t later_ns : {int64_t(200'000'000), int64_t(-5)}) {
        PoseDifferentiator motion;
        motion.take({}, 1'000'000);
        motion.take({{0.001, 0, 0}, Eigen::Quaterniond::Identity()}, 2'000'000);
        EXPECT_GT(motion.v_DT().x(), 0.1);
        motion.take({{0.5, 0, 0}, Eigen::Quaterniond::Identity()}, 2'000'000 + later_ns);
        EXPECT_EQ(motion.v_DT().x(), 0);
    }
}

// Stamps come from outside; the sanitizers see an overflow.
TEST(PoseDifferentiator, TakesStampsThatLieFartherApartThanTheirDifferenceCanSay) {
    PoseDifferentiator motion;
    for (const int64_t stamp_ns : {INT64_MAX, INT64_MIN, INT64_MAX - 5}) {
        motion.take({}, stamp_ns);
        EXPECT_EQ(motion.v_DT().norm(), 0) << stamp_ns;
    }
}

}  // namespace
}  // namespace bonemill
