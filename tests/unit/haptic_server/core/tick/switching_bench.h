// Puts a slab under a burr, with a tick whose accuracy is switched to the next preset every 50 ticks.
#pragma once

#include <array>

#include "haptic_server/core/tick/haptic_tick.h"
#include "tests/support/milling_config.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {

inline constexpr double kBenchTop = 5e-3;  // bone fills z < kBenchTop (V = W)
inline constexpr double kBenchBurr = 1e-3;

// The bone has shell levels for every preset.
struct SwitchingBench {
    static constexpr size_t kTicksPerPreset = 50;

    explicit SwitchingBench(const AccuracySettings& start = presetSettings(Preset::kBalanced))
        : bone(bodyVolume(cubeGeometry(64, 0.125e-3), halfSpace({0, 0, kBenchTop}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), shellLevels()),
          tool(sphereToolModel(kBenchBurr, 0.125e-3)),
          tools({{&tool}}),
          accuracy(start),
          tick(millingConfig(), {bone}, {tools, accuracy}) {}

    static ShellConfig shellLevels() {
        ShellConfig config;
        config.levels = {{1}, {2}, {3}};
        return config;
    }
    static Pose at(double z) { return {{4.05e-3, 3.95e-3, z}, Eigen::Quaterniond::Identity()}; }

    void runSwitching(ScriptedIo& io) noexcept {
        size_t n = 0;
        do {
            accuracy.choose(AccuracySwitch::choiceOf(presetAt(n++)));
        } while (io.step(tick));
    }
    // In this order each preset follows each other one.
    static Preset presetAt(size_t tick) noexcept {
        constexpr std::array<size_t, 12> kOrder{0, 1, 0, 2, 0, 3, 1, 2, 3, 2, 1, 3};
        return kPresets[kOrder[tick / kTicksPerPreset % kOrder.size()]];
    }

    BoneModel bone;
    ToolModel tool;
    ToolSwitch tools;
    AccuracySwitch accuracy;
    HapticTick tick;
};

}  // namespace bonemill::test
