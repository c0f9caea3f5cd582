// The effects of a driven burr allocate nothing and take no lock, alone and all together.
#include <gtest/gtest.h>

#include <functional>

#include "haptic_server/core/tick/fixed_tick.h"
#include "tests/support/rt_guard/rt_probe.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

void expectQuiet(const std::function<void(EffectConfigs&)>& choose) {
    BoneModel bone(test::bodyVolume(test::cubeGeometry(48, 0.125e-3),
                                    test::halfSpace({0, 0, 4e-3}, Eigen::Vector3d::UnitZ())),
                   Eigen::Vector3i::Constant(16), ShellConfig{});
    const ToolModel tool = test::sphereToolModel(1e-3, 0.125e-3);
    FixedTickConfig config;
    config.tool = {&tool, {.speed = 4000}};
    choose(config.effects);
    FixedTick tick(config, bone);
    const Pose above{{3e-3, 3e-3, 5.1e-3}, Eigen::Quaterniond::Identity()};
    for (const uint32_t buttons : {0u, uint32_t(kButtonRemove), 0u}) {
        test::ScriptedIo io(test::straightPath(above, {3.3e-3, 2.8e-3, 3.5e-3}, 300, buttons));
        RtProbe probe;
        io.lead(tick);
        probe.stop();
        EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
        EXPECT_GT(io.records.back().contacts, 0u);
    }
}

TEST(BurrEffectsAreRtSafe, Spindle) {
    expectQuiet([](EffectConfigs& effects) { effects.spindle = test::kSpindle; });
}
TEST(BurrEffectsAreRtSafe, CuttingForce) {
    expectQuiet([](EffectConfigs& effects) { effects.cutting_force = test::kCuttingForce; });
}
TEST(BurrEffectsAreRtSafe, BurrVibration) {
    expectQuiet([](EffectConfigs& effects) { effects.burr_vibration = test::kBurrVibration; });
}
TEST(BurrEffectsAreRtSafe, SurfaceFriction) {
    expectQuiet([](EffectConfigs& effects) { effects.surface_friction = test::kSurfaceFriction; });
}
TEST(BurrEffectsAreRtSafe, AllTogether) {
    expectQuiet([](EffectConfigs& effects) {
        effects.spindle = test::kSpindle;
        effects.cutting_force = test::kCuttingForce;
        effects.burr_vibration = test::kBurrVibration;
        effects.surface_friction = test::kSurfaceFriction;
        effects.time_removal = TimeRemovalConfig{.rate = 20 * kDensityCountsPerUnit};  // slower than the hand
    });
}

}  // namespace
}  // namespace bonemill
