// What the tick calls of the link neither allocates nor locks.
#include <gtest/gtest.h>

#include "common/ipc/device_link.h"
#include "common/ipc/stale_ramp.h"
#include "common/rt/clock.h"
#include "tests/support/rt_guard/rt_probe.h"
#include "tests/unit/common/ipc/link_test_tools.h"

namespace bonemill {
namespace {

TEST(DeviceLinkInTick, neitherAllocatesNorLocks) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    StaleRamp ramp;
    DeviceSample sample{};
    WrenchCommand command{};
    bool is_done = true;
    RtProbe probe;
    for (int i = 0; i < 10; ++i) {
        sample.stamp_ns = monotonicNowNs();
        daemon.writeSample(sample);
        is_done &= server.waitForSample(sample.stamp_ns) && server.readSample(sample) && !isPlausible(sample);
        ramp.update(monotonicNowNs(), sample.stamp_ns);
        server.writeCommand(command);
        is_done &= daemon.readCommand(command) && !daemon.waitForCommand(sample.stamp_ns);
    }
    probe.stop();
    EXPECT_TRUE(is_done);
    EXPECT_EQ(probe.heapCalls() + probe.lockCalls(), 0u) << probe.firstCall();
}

}  // namespace
}  // namespace bonemill
