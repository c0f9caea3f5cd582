// Puts a slab under three burrs, with a tick whose tool is changed.
#pragma once

#include "haptic_server/core/tick/haptic_tick.h"
#include "tests/support/led_tick.h"
#include "tests/support/milling_config.h"
#include "tests/unit/haptic_server/core/tick/switching_bench.h"

namespace bonemill::test {

inline constexpr double kBurrs[] = {0.5e-3, 1e-3, 1.5e-3};  // radius, m

// ARES' own figures: they carry the whole stiffness of a scene.
inline constexpr HandleDynamics kSteadyHandle{.mass = 0.25,
                                              .damping = 2,
                                              .inertia = 1e-4,
                                              .angular_damping = 0.004,
                                              .amplifier_time = 0.3e-3,
                                              .delay = 1e-3,
                                              .encoder_step = 5e-6,
                                              .encoder_angle = 1e-4};

struct ToolBench {
    static constexpr size_t kTicksPerTool = 120;

    explicit ToolBench(size_t first = 0, const AccuracySettings& settings = presetSettings(Preset::kBalanced))
        : bone(bodyVolume(cubeGeometry(64, 0.125e-3), halfSpace({0, 0, kBenchTop}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), SwitchingBench::shellLevels()),
          models{sphereToolModel(kBurrs[0], 0.125e-3), sphereToolModel(kBurrs[1], 0.125e-3),
                 sphereToolModel(kBurrs[2], 0.125e-3)},
          history(bone),
          tools({{&models[0], {.radius = kBurrs[0]}, 5},
                 {&models[1], {.radius = kBurrs[1]}, 10},
                 {&models[2], {.radius = kBurrs[2]}, 15}},
                first),
          accuracy(settings),
          tunings(tuned([](TickTuning&) {})),
          tick(millingConfig(), {bone, &history}, {tools, accuracy, &tunings}) {}

    // What the bench's config says, changed by this.
    template <class Change>
    static TickTuning tuned(Change change) {
        const TickConfig config = millingConfig();
        TickTuning tuning{
            config.coupling, config.gradient.coupling, config.gradient.contact, config.hand, {5, 10, 15}};
        change(tuning);
        return tuning;
    }
    template <class Change>
    void tune(Change change) {
        tunings.choose(tunings.add(tuned(change)));
    }

    std::vector<TickRecord> run(const std::vector<DeviceInput>& inputs) { return lead(tick, inputs); }
    void runChanging(ScriptedIo& io) noexcept {
        constexpr std::array<size_t, 6> kOrder{0, 1, 2, 0, 2, 1};
        size_t n = 0;
        do {
            tools.choose(kOrder[n++ / kTicksPerTool % kOrder.size()]);
        } while (io.step(tick));
    }

    BoneModel bone;
    std::array<ToolModel, 3> models;
    BoneHistory history;
    ToolSwitch tools;
    AccuracySwitch accuracy;
    TuningSwitch tunings;
    HapticTick tick;
};

}  // namespace bonemill::test
