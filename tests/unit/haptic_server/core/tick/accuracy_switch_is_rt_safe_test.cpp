// A change of the accuracy is taken up inside the tick without allocation or lock.
#include <gtest/gtest.h>

#include <set>

#include "tests/support/rt_guard/rt_probe.h"
#include "tests/unit/haptic_server/core/tick/switching_bench.h"

namespace bonemill {
namespace {

void expectQuiet(double to_z, uint32_t buttons) {
    test::SwitchingBench bench;
    test::ScriptedIo io(test::straightPath(bench.at(6.2e-3), bench.at(to_z).position, 1300, buttons));
    RtProbe probe;
    bench.runSwitching(io);
    probe.stop();
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    uint64_t contacts = 0, removed = 0;
    for (const TickRecord& r : io.records) {
        contacts += r.contacts;
        removed += r.removed_voxels;
    }
    EXPECT_GT(contacts, 0u);
    EXPECT_EQ(removed > 0, buttons == kButtonRemove);
}

TEST(AccuracySwitchIsRtSafe, WhilePressing) {
    expectQuiet(5.4e-3, 0);
}

TEST(AccuracySwitchIsRtSafe, WhileMilling) {
    expectQuiet(3e-3, kButtonRemove);
}

}  // namespace
}  // namespace bonemill
