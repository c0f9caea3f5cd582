// With materials, protected structures, fixture and heat the tick allocates nothing and takes no lock.
#include <gtest/gtest.h>

#include "tests/support/rt_guard/rt_probe.h"
#include "tests/support/typical_effects.h"
#include "tests/unit/haptic_server/core/effects/tissue_bench.h"

namespace bonemill {
namespace {

using namespace test;

TEST(TissueEffectsAreRtSafe, WhileMillingThroughAllOfThem) {
    TissueBench bench(sphereAt({4e-3, 4e-3, 3e-3}, 0.8e-3));
    EffectConfigs& effects = bench.config.effects;
    effects.materials[kNerve].stiffness_factor = 0.5;
    effects.material_stiffness.emplace();
    effects.time_removal = TimeRemovalConfig{.rate = 200 * kDensityCountsPerUnit};  // slower than the hand
    effects.thermal = test::kThermal;
    effects.virtual_fixture = test::kVirtualFixture;
    effects.virtual_fixture->stiffness = 500;
    effects.virtual_fixture->hand_force_scale = 0.5;
    effects.protected_structures = test::kProtectedStructures;
    bench.config.tool.burr.speed = 3000;
    BoneHistory history(bench.bone);
    FixedTick tick = bench.makeTick(&history);
    ScriptedIo io(
        straightPath(TissueBench::at({4e-3, 4e-3, 6.2e-3}), {4e-3, 4e-3, 2e-3}, 1500, kButtonRemove));
    RtProbe probe;
    io.lead(tick);
    probe.stop();
    EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
    EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
    const EffectRecord& last = io.records.back().effects;
    EXPECT_GT(last.damaged_volume, 0);
    EXPECT_GT(last.temperature, 37);

    history.restore();
    ScriptedIo back(straightPath(TissueBench::at({4e-3, 4e-3, 2e-3}), {4e-3, 4e-3, 2e-3}, 100, 0));
    RtProbe forgets;
    back.lead(tick);
    forgets.stop();
    EXPECT_EQ(forgets.heapCalls(), 0u) << forgets.firstCall();
    EXPECT_EQ(forgets.lockCalls(), 0u) << forgets.firstCall();
    EXPECT_EQ(back.records.back().effects.damaged_volume, 0);
}

}  // namespace
}  // namespace bonemill
