// A period of the device loop neither allocates nor locks, in whatever state it is.
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/rt_guard/rt_probe.h"
#include "tests/unit/device_daemon/control/device_loop/loop_rig.h"

namespace bonemill {
namespace {

TEST(DeviceLoopInTick, NeitherAllocatesNorLocks) {
    test::LoopRig rig;
    rig.server = [](WrenchCommand& c) { test::LoopRig::setForce(c, 0); };
    rig.step();
    rig.device.reading.status |= kStatusEnabled;
    RtProbe probe;
    bool was_engaged = false, was_stopped = false;
    for (int i = 0; i < 1200; ++i) {
        if (i == 400) rig.device.reading.v_DT = {3, 0, 0};
        if (i == 500) ++rig.command.reset_orders, rig.device.reading.v_DT.setZero();
        if (i == 600) rig.command.f_hand_D[0] = std::numeric_limits<double>::quiet_NaN();
        if (i == 700) rig.device.is_heard = false;
        if (i == 900) rig.is_server_there = false;
        if (i == 1000) rig.loop.release();
        rig.step();
        was_engaged |= rig.state() == SafetyState::kEngaged;
        was_stopped |= rig.state() == SafetyState::kProtectiveStop;
    }
    probe.stop();
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    EXPECT_TRUE(was_engaged && was_stopped && rig.loop.isReleased());
}

}  // namespace
}  // namespace bonemill
