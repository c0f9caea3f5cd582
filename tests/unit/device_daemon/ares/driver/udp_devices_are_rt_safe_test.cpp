// The devices behind the wire allocate nothing and take no lock, whatever comes: an answering controller, its
// silence, garbage, and the way back.
#include <gtest/gtest.h>

#include "device_daemon/ares/driver/udp_device.h"
#include "device_daemon/ares/driver/udp_pose_device.h"
#include "tests/support/rt_guard/rt_probe.h"
#include "tests/unit/device_daemon/ares/driver/wire_controller.h"

namespace bonemill {
namespace {

wire::Describe jointsOf(wire::Describe d) {
    d.max_actuator_force = 40;
    d.stroke = 0.15;
    return d;
}

TEST(UdpDevicesAreRtSafe, InEveryWayThatAPeriodCanGo) {
    test::WireController<wire::JointPackets> joints(jointsOf(test::testDescription()));
    test::WireController<wire::PosePackets> poses(test::testDescription());
    poses.state.q_DT[0] = 1;
    for (float& v : poses.state.v_DT) v = std::numeric_limits<float>::quiet_NaN();
    for (float& w : poses.state.w_DT) w = std::numeric_limits<float>::quiet_NaN();
    UdpJointDevice joint_device({.controller = joints.link.local()});
    UdpPoseDevice pose_device({.controller = poses.link.local()});
    wire::UdpSocket stranger;

    DeviceOrder order;
    order.is_wanted = true;
    bool was_driving = false, was_heard_posing = false;
    RtProbe probe;
    for (int i = 0; i < 600; ++i) {
        JointReading reading;
        DeviceReading pose;
        joint_device.waitForSample(monotonicNowNs() + 100'000);
        joint_device.readJoints(1e-3, reading);
        was_driving |= (reading.status & kStatusDriving) != 0;
        joint_device.applyForces({.forces = Vector6d::Constant(1),
                                  .is_wanted = i % 200 < 150,
                                  .is_engaged = true,
                                  .reset = i % 50 == 0});
        pose_device.waitForSample(0);
        was_heard_posing |= pose_device.read(1e-3, pose);
        pose_device.write(order);
        const std::byte garbage[50] = {};
        if (i % 3 == 0) stranger.send(garbage, joint_device.local());
        if (i > 300 && i < 320) continue;
        joints.faults = i == 250 ? wire::kFaultEncoder : 0u;
        joints.period();
        poses.period();
    }
    probe.stop();
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    EXPECT_TRUE(was_driving);
    EXPECT_TRUE(was_heard_posing);
}

}  // namespace
}  // namespace bonemill
