#include "device_daemon/bridges/bridge/bridge_link.h"

#include <gtest/gtest.h>

#include <limits>

#include "device_daemon/ares/wire/host_session.h"

namespace bonemill::bridge {
namespace {

using wire::DriveState;

// A bridge and its host in one thread, whose clock the test moves: every period of both is 1 ms.
class BridgeLinkTest : public testing::Test {
  protected:
    BridgeLinkTest() {
        reading_.is_valid = reading_.is_homed = reading_.is_powered = true;
        reading_.X_DT.position = {0.01, 0.02, 0.03};
    }

    ArmOrder period() {
        now_ns_ += kPeriodNs;
        const ArmOrder order = bridge_.step(reading_, now_ns_);
        if (!is_host_alive_) return order;
        host_.poll(now_ns_);
        wire::PoseCommand command{};
        command.mode = wire::kModeTorque;
        command.controlword = controlword_ ? *controlword_ : wire::controlwordTowards(true, drive());
        command.wrench[0] = 2;
        host_.send(command, now_ns_);
        return order;
    }
    ArmOrder periods(int count) {
        ArmOrder order;
        for (int i = 0; i < count; ++i) order = period();
        return order;
    }
    const wire::PoseState& state() const { return host_.session().state(); }
    DriveState drive() const { return wire::driveStateOf(state().statusword); }

    static ArmDescription arm() {
        ArmDescription arm;
        arm.name = "test arm";
        arm.max_force = 5;
        return arm;
    }

    int64_t now_ns_ = 1'000'000'000;
    ArmReading reading_;
    BridgeLink bridge_{arm(), {wire::kLoopback, 0}};
    wire::HostLink<wire::PosePackets> host_{{bridge_.local(), wire::kLongestWatchdogUs, 42},
                                            {wire::kLoopback, 0}};
    bool is_host_alive_ = true;
    std::optional<uint16_t> controlword_;
};

TEST_F(BridgeLinkTest, GivesForceOnceTheHostHasEnabledIt) {
    controlword_ = wire::kControlDisable;
    for (int i = 0; i < 100; ++i) {
        const ArmOrder order = period();
        EXPECT_FALSE(order.is_driving);
        EXPECT_EQ(order.wrench_D.force.norm(), 0);
    }
    EXPECT_NEAR(state().p_DT[1], 0.02, 1e-15);
    controlword_.reset();
    const ArmOrder order = periods(100);
    EXPECT_TRUE(order.is_driving);
    EXPECT_NEAR(order.wrench_D.force.x(), 2, 1e-6);
    EXPECT_EQ(drive(), DriveState::kOperationEnabled);
}

TEST_F(BridgeLinkTest, MotorsStayOnWithZeroWhenTheHostIsSilent) {
    periods(100);
    is_host_alive_ = false;
    EXPECT_GT(periods(25).wrench_D.force.x(), 1.9) << "within the watchdog's 30 ms";
    const ArmOrder later = periods(30);
    EXPECT_EQ(later.wrench_D.force.norm(), 0);
    EXPECT_TRUE(later.is_driving);
    EXPECT_TRUE(periods(5000).is_driving);
}

TEST_F(BridgeLinkTest, MotorsGoOffWhenTheHostSaysSoAndTheForceHasFaded) {
    periods(100);
    controlword_ = wire::kControlDisable;
    bool was_driven_with_force = false;
    ArmOrder order;
    for (int i = 0; i < 80; ++i) {
        order = period();
        EXPECT_TRUE(order.is_driving || order.wrench_D.force.norm() == 0);
        was_driven_with_force |= order.is_driving && order.wrench_D.force.norm() < 1;
    }
    EXPECT_TRUE(was_driven_with_force) << "it fades";
    EXPECT_FALSE(order.is_driving);
}

TEST_F(BridgeLinkTest, TheArmDoesNotFallWhileAFaultOfTheLinkIsReset) {
    periods(100);
    is_host_alive_ = false;
    periods(50);
    is_host_alive_ = true;
    for (int i = 0; i < 400; ++i) {
        // As a host does that resets, and has not yet seen that it helped.
        const bool is_fault = drive() == DriveState::kFault;
        controlword_ =
            !is_fault ? std::nullopt : std::optional<uint16_t>(i % 2 ? wire::kControlFaultReset : 0);
        EXPECT_TRUE(period().is_driving);
    }
    EXPECT_EQ(drive(), DriveState::kOperationEnabled);
}

TEST_F(BridgeLinkTest, AnArmThatIsNotHomedIsNotEnabled) {
    reading_.is_homed = false;
    EXPECT_FALSE(periods(200).is_driving);
    EXPECT_FALSE(state().inputs & wire::kInputHomed);
    reading_.is_homed = true;
    EXPECT_TRUE(periods(200).is_driving);
    reading_.is_homed = false;
    EXPECT_EQ(periods(40).wrench_D.force.norm(), 0);
    EXPECT_EQ(drive(), DriveState::kSwitchOnDisabled);
}

TEST_F(BridgeLinkTest, TroubleIsForgivenThenAFaultThenTheArmIsLost) {
    periods(100);
    reading_.is_valid = false;
    periods(10);
    EXPECT_FALSE(state().active_faults & wire::kFaultSdk);
    reading_.is_valid = true;
    EXPECT_NEAR(periods(60).wrench_D.force.x(), 2, 1e-6);
    reading_.is_valid = false;
    reading_.fault_code = 7;
    EXPECT_EQ(periods(30).wrench_D.force.norm(), 0);
    EXPECT_TRUE(state().active_faults & wire::kFaultSdk);
    EXPECT_EQ(state().fault_code, 7u);
    EXPECT_FALSE(bridge_.isArmLost());
    EXPECT_FALSE(periods(1600).is_driving);
    EXPECT_TRUE(bridge_.isArmLost());
    EXPECT_EQ(bridge_.faultCode(), 7u);
}

TEST_F(BridgeLinkTest, AFaultOfTheArmSwitchesItOff) {
    periods(100);
    reading_.faults = wire::kFaultOverSpeed;
    const ArmOrder order = period();
    EXPECT_FALSE(order.is_driving);
    EXPECT_EQ(order.wrench_D.force.norm(), 0);
    periods(2);
    EXPECT_EQ(state().first_fault, uint32_t(wire::kFaultOverSpeed));
}

TEST_F(BridgeLinkTest, LeavesWithFadedForceAndSaysSo) {
    periods(100);
    bridge_.leave();
    EXPECT_FALSE(bridge_.hasLeft());
    EXPECT_EQ(periods(30).wrench_D.force.norm(), 0);
    EXPECT_TRUE(bridge_.hasLeft());
    EXPECT_TRUE(state().inputs & wire::kInputLeaving);
}

TEST_F(BridgeLinkTest, VelocitiesAreAllThereOrNone) {
    periods(50);
    EXPECT_TRUE(std::isnan(state().v_DT[0]) && std::isnan(state().w_DT[2]));
    reading_.has_velocity = true;
    reading_.v_DT = {0.5, 0, 0};
    periods(2);
    EXPECT_EQ(state().v_DT[0], 0.5f);
    reading_.w_DT.y() = std::numeric_limits<double>::infinity();
    periods(2);
    EXPECT_TRUE(std::isnan(state().v_DT[0]) && std::isnan(state().w_DT[2]));
}

}  // namespace
}  // namespace bonemill::bridge
