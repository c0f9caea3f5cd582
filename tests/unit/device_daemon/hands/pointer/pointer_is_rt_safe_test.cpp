// What the loop does with the pointer allocates nothing and takes no lock, also while wishes come in.
#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "device_daemon/hands/pointer/pointer_device.h"
#include "tests/support/hand_pointer.h"
#include "tests/support/rt_guard/rt_probe.h"

namespace bonemill {
namespace {

TEST(PointerIsRtSafe, WhileAViewerHoldsItAndForcesOfEveryKindCome) {
    PointerDevice device({.domain = testDomain(), .session = testSession()});
    std::atomic<bool> stop = false;
    std::thread viewer([&] {
        test::PointingViewer mouse(1);
        for (int i = 0; !stop; ++i) {
            mouse.want({{0.001 * (i % 20), 0, 0}, expRotation({0, 0.01 * (i % 20), 0})},
                       uint32_t(i / 10 % 3));
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    });
    DeviceReading reading;
    int held = 0;
    RtProbe probe;
    for (int i = 0; i < 200000 && held < 500; ++i) {
        device.waitForSample(0);
        device.read(1e-4, reading);
        DeviceOrder order;
        order.is_engaged = i % 5 != 0;
        order.wrench_hand_D.force.z() = i % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : 5;
        device.write(order);
        if (reading.status & kStatusEnabled) {
            ++held;
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    probe.stop();
    stop = true;
    viewer.join();
    EXPECT_EQ(held, 500);
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    EXPECT_TRUE(reading.X_DT.isFinite());
}

}  // namespace
}  // namespace bonemill
