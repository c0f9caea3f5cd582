// A scene without an effect is the server without it: tick by tick and bit for bit.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/units.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/every_effect_scene.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

struct Outcome {
    std::vector<uint64_t> ticks;  // hash of each record, the effects' part included
    uint64_t volume = 0;
    double removed = 0, added = 0;  // m³

    bool operator==(const Outcome& other) const { return ticks == other.ticks && volume == other.volume; }
};

// Touches the face, slides, mills into the protected layer, slides along the pit's wall, lays material down,
// leaves.
std::vector<DeviceInput> pathOver(const BoneModel& bone, double burr_radius) {
    struct Phase {
        int ticks;
        double x, z;  // m, from the middle of the face, of the burr's lowest point, at its end
        uint32_t buttons;
    };
    constexpr Phase kPhases[] = {{60, 0, 0.2e-3, 0},
                                 {100, 0, -0.2e-3, 0},
                                 {100, 0.5e-3, -0.2e-3, 0},
                                 {400, 1e-3, -1.8e-3, kButtonRemove},
                                 {100, -0.5e-3, -1.8e-3, kButtonRemove},
                                 {60, -0.9e-3, -1.8e-3, 0},
                                 {60, -0.9e-3, -1.3e-3, 0},
                                 {80, -0.5e-3, 0.5e-3, kButtonAdd},
                                 {60, -0.5e-3, 1.5e-3, 0}};
    const Eigen::Vector3d size = bone.volume.spacing().cwiseProduct(bone.volume.dims().cast<double>());
    const Eigen::Quaterniond upright(M_SQRT1_2, M_SQRT1_2, 0, 0);
    std::vector<DeviceInput> path;
    double x = 0, z = 0.5e-3;
    for (const Phase& phase : kPhases) {
        const double from_x = x, from_z = z;
        for (int n = 1; n <= phase.ticks; ++n) {
            x = from_x + (phase.x - from_x) * n / phase.ticks;
            z = from_z + (phase.z - from_z) * n / phase.ticks;
            DeviceInput input;
            input.X_WT_device = bone.volume.geometry().X_WV *
                                Pose{size / 2 + Eigen::Vector3d(x, 0, z + burr_radius), upright};
            input.buttons = phase.buttons;
            input.t_s = double(path.size()) * kMillisecond;
            path.push_back(input);
        }
    }
    return path;
}

class EffectIdentity : public testing::TestWithParam<const char*> {
  protected:
    EffectIdentity() {
        test::writeBlock(folder_.path().string(), block_);
        scene_ = test::everyEffectScene(block_, GetParam());
        // It is slow enough to leave something to the others.
        if (scene_.effects().has_time_removal())
            scene_.mutable_effects()->mutable_time_removal()->set_rate_density_per_s(2500);
        // And sharp enough to get to the other layer.
        if (scene_.effects().has_energy_removal())
            scene_.mutable_effects()->mutable_energy_removal()->set_fluted_edge_n_per_mm(0.2);
    }
    SceneSetup simulationOf(const scene::Scene& scene) const {
        test::writeScene(folder_ / "scene.textproto", scene);
        return setUpScene(loadScene(folder_ / "scene.textproto"));
    }
    // The run takes `effects`, if given, instead of the scene's own, on a bone that nobody has touched.
    Outcome run(const scene::Scene& scene, const EffectConfigs* effects = nullptr) const {
        SceneSetup simulation = simulationOf(scene);
        if (effects) simulation.tick.effects = *effects;
        BoneModel& bone = *simulation.bone;
        Outcome outcome;
        for (const TickRecord& record :
             runPath(simulation.fixedTick(), bone, pathOver(bone, block_.burr_radius_mm * kMillimetre))) {
            StateHash hash;
            hash.addRecord(record);
            hash.addBytes(&record.effects, sizeof record.effects);
            outcome.ticks.push_back(hash.value());
            outcome.removed += record.removed;
            outcome.added += record.added;
        }
        StateHash hash;
        hash.addVolume(bone.volume);
        outcome.volume = hash.value();
        return outcome;
    }

    test::EveryEffectBlock block_;
    test::TemporaryFolder folder_;
    scene::Scene scene_;
};

TEST_P(EffectIdentity, SceneWithoutAnEffectIsTheTickThatWasNeverGivenIt) {
    const EffectConfigs all = simulationOf(scene_).tick.effects;
    const Outcome with_all = run(scene_);
    EXPECT_GT(with_all.removed, 0.5e-9);
    EXPECT_GT(with_all.added, 0.01e-9);
    for (const std::string& name : effectNames(all)) {
        const EffectConfigs without = withoutEffect(all, name);
        const Outcome of_config = run(scene_, &without), of_scene = run(test::withoutEffect(scene_, name));
        EXPECT_EQ(of_scene, of_config) << name;
        EXPECT_FALSE(of_scene == with_all) << name << " did nothing on this way: the comparison says nothing";
    }
}

TEST_P(EffectIdentity, SceneWithNoneIsTheTickThatKnowsNoEffects) {
    scene::Scene none = scene_;
    none.clear_effects();
    none.clear_material();
    const EffectConfigs nothing;
    const Outcome of_scene = run(none), of_config = run(scene_, &nothing);
    EXPECT_EQ(of_scene, of_config);
    EXPECT_EQ(of_scene.removed, 0);
    EXPECT_FALSE(of_scene == run(scene_));
}

TEST_P(EffectIdentity, EveryRunIsTheSame) {
    EXPECT_EQ(run(scene_), run(scene_));
}

INSTANTIATE_TEST_SUITE_P(Laws, EffectIdentity, testing::Values(test::kByTime, test::kByEnergy),
                         [](const auto& law) { return std::string(law.param); });

TEST(EffectConfigs, EveryEffectOfTheTickIsAFieldOfTheScene) {
    std::vector<std::string> fields = test::tickEffectNames();
    fields.push_back(test::kMaterialStiffness);
    const EffectConfigs configs;
    forEachEffect(configs, [&](const auto& config) {
        const std::string name = nameOf(config);
        EXPECT_FALSE(config) << name << ": what is not listed must not be there";
        EXPECT_NE(std::find(fields.begin(), fields.end(), name), fields.end()) << name;
    });
}

}  // namespace
}  // namespace bonemill
