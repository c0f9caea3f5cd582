#include "device_daemon/ares/ares_device/wired_ares.h"

#include <gtest/gtest.h>

#include "tests/unit/device_daemon/ares/driver/wire_controller.h"

namespace bonemill {
namespace {

// Of a controller that has the ARES of the default scene, with its handle in the neutral pose.
wire::Describe descriptionOfDefault() {
    const AresDeviceConfig ares;
    wire::Describe d = test::testDescription();
    d.kind = uint32_t(DeviceKind::kAres);
    d.max_force = ares.max_force;
    d.max_torque = ares.max_torque;
    d.max_actuator_force = ares.max_actuator_force;
    d.encoder_step = ares.guard.encoder_step;
    d.stroke = ares.geometry.stroke;
    return d;
}

class WiredAresTest : public testing::Test {
  protected:
    struct Link {
        explicit Link(const wire::Describe& description) : controller(description) {
            Vector6d q;
            EXPECT_TRUE(AresKinematics{}.inverse({}, q));
            Eigen::Map<Vector6d>(controller.state.q) = q;
        }
        // Takes turns with the daemon, which wants the motors.
        bool runUntil(const std::function<bool()>& condition) {
            return test::takeTurns(
                [&] {
                    device.waitForSample(0);
                    is_believed = device.read(1e-3, reading);
                    device.write(order);
                },
                [&] { controller.period(); }, condition);
        }
        bool isDriving() const {
            return controller.link.session().drive().state() == wire::DriveState::kOperationEnabled;
        }

        test::WireController<wire::JointPackets> controller;
        DeviceOrder order{.wrench_hand_D = {}, .is_wanted = true};
        WiredAres device{{}, {.controller = controller.link.local()}};
        DeviceReading reading;
        bool is_believed = false;
    };
};

TEST_F(WiredAresTest, DrivesTheControllerThatTheSceneDescribes) {
    wire::Describe description = descriptionOfDefault();
    description.stroke *= 1 + 1e-6;  // millimetres and metres round
    Link link(description);
    EXPECT_TRUE(link.runUntil([&] { return link.isDriving() && link.is_believed; }));
    EXPECT_EQ(link.device.refusal(), "");
}

TEST_F(WiredAresTest, RefusesAControllerThatHasAnotherAres) {
    struct {
        double wire::Describe::*figure;
        double described;
        const char* says;
    } const cases[] = {
        {&wire::Describe::stroke, 0.140, "its stroke is 140, field `device.stroke_mm` says 151;"},
        {&wire::Describe::encoder_step, 20e-6, "`device.encoder_step_um` says 5;"},
        {&wire::Describe::max_actuator_force, 30, "is 30, field `device.max_actuator_force_n` says 50;"},
        {&wire::Describe::max_force, 20, "is 20, field `device.max_force_n` says 50;"},
        {&wire::Describe::max_torque, 0.5, "is 500, field `device.max_torque_nmm` says 1000;"}};
    for (const auto& [figure, described, says] : cases) {
        wire::Describe description = descriptionOfDefault();
        description.*figure = described;
        Link link(description);
        EXPECT_EQ(link.device.refusal(), "") << "nothing was described yet";
        int states = 0;
        ASSERT_TRUE(link.runUntil([&] {
            EXPECT_FALSE(link.is_believed);
            EXPECT_FALSE(link.isDriving());
            return ++states == 200;
        }));
        EXPECT_EQ(link.reading.fault, StopCause::kDeviceFault);
        EXPECT_EQ(link.reading.fault_code, kAresIsAnother);
        const std::string why = link.device.refusal();
        EXPECT_NE(why.find(says), std::string::npos) << why;
        EXPECT_NE(why.find(wire::textOf(link.controller.link.local())), std::string::npos) << why;
    }
}

}  // namespace
}  // namespace bonemill
