// A block of sound neither allocates nor locks.
#include <gtest/gtest.h>

#include <vector>

#include "render_client/sound/milling_synth.h"
#include "tests/support/rt_guard/rt_probe.h"

namespace bonemill {
namespace {

TEST(MillingSynthMemory, aBlockNeitherAllocatesNorLocks) {
    MillingSynth synth{scene::MillingSound()};
    std::vector<float> block(768);
    RtProbe probe;
    for (int n = 0; n < 20; ++n) {
        synth.setLoad({300.0 * n, 0.2 * n, 0.5 * n});
        synth.render(block);
    }
    probe.stop();
    EXPECT_EQ(probe.heapCalls() + probe.lockCalls(), 0u) << probe.firstCall();
}

}  // namespace
}  // namespace bonemill
