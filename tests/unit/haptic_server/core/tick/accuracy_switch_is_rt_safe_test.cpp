// A change of the accuracy, or of the tuning, is taken up inside the tick without allocation or lock.
#include <gtest/gtest.h>

#include <set>

#include "tests/support/rt_guard/rt_probe.h"
#include "tests/unit/haptic_server/core/tick/switching_bench.h"
#include "tests/unit/haptic_server/core/tick/tool_bench.h"

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

TEST(TuningIsRtSafe, WhilePressingAndMilling) {
    for (const uint32_t buttons : {0u, uint32_t(kButtonRemove)}) {
        test::ToolBench bench(1);
        uint32_t last = 0;
        for (int n = 1; n <= 5; ++n)
            last = bench.tunings.add(test::ToolBench::tuned([n](TickTuning& t) {
                t.gradient.translation_stiffness *= n;
                t.contact.stiffness_per_area /= n;
            }));
        test::ScriptedIo io(test::straightPath(test::SwitchingBench::at(6.2e-3),
                                               test::SwitchingBench::at(5e-3).position, 1000, buttons));
        uint32_t n = 0;
        RtProbe probe;
        do {
            bench.tunings.choose(n++ / 20 % (last + 1));
        } while (io.step(bench.tick));
        probe.stop();
        EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(io.records.back().input.decisions.tuning, (1000 - 1) / 20 % (last + 1));
    }
}

}  // namespace
}  // namespace bonemill
