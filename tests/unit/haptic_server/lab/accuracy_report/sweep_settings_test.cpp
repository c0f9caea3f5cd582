#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/base/user_error.h"
#include "haptic_server/lab/accuracy_report/sweep.h"
#include "haptic_server/scene/setup/scene_accuracy.h"

namespace bonemill {
namespace {

const AccuracySettings kOdd{ContactLaw::kGradient, 5, 3,    100, ToolDistance::kGrid, 3,
                            Precision::kDouble,    7, false};

bool contains(const std::vector<AccuracySettings>& all, const AccuracySettings& settings) {
    return std::find(all.begin(), all.end(), settings) != all.end();
}

TEST(SweepSettings, HoldThePresetsTheScenesOwnAndNoTwoEqual) {
    for (const bool has_shapes : {true, false}) {
        const auto all = sweepSettings(kOdd, has_shapes);
        EXPECT_TRUE(contains(all, kOdd));
        for (const Preset preset : allPresets()) EXPECT_TRUE(contains(all, presetSettings(preset)));
        std::set<std::string> names;
        for (const AccuracySettings& settings : all) names.insert(settingsName(settings));
        EXPECT_EQ(names.size(), all.size());
        EXPECT_GE(all.size(), 18u);
        EXPECT_LE(all.size(), 29u);
    }
}

TEST(SweepSettings, AreChosenByName) {
    const auto all = sweepSettings(kOdd, true);
    EXPECT_EQ(settingsNamed({}, all, kOdd), all);
    const auto chosen = settingsNamed({"Exact", "fast", "exact"}, all, kOdd);
    EXPECT_EQ(chosen, (std::vector{presetSettings(Preset::kExact), presetSettings(Preset::kFast), kOdd}));
    EXPECT_THROW(settingsNamed({"fast", "faster"}, all, kOdd), UserError);
}

TEST(SweepSettings, AMeshToolHasOnlyGrids) {
    for (const AccuracySettings& settings : sweepSettings(presetSettings(Preset::kBalanced), false)) {
        const bool is_preset = presetOfName(settingsName(settings)).has_value();
        EXPECT_TRUE(is_preset || settings.tool_distance == ToolDistance::kGrid) << settingsName(settings);
    }
}

TEST(SweepSettings, EveryKnobVariesAroundBalanced) {
    const AccuracySettings base = presetSettings(Preset::kBalanced);
    const auto all = sweepSettings(base, true);
    AccuracySettings s = base;
    s.shell_factor = 3;
    EXPECT_TRUE(contains(all, s));
    s = base, s.sample_spacing = presetSettings(Preset::kExact).sample_spacing,
    s.most_samples = presetSettings(Preset::kExact).most_samples;
    EXPECT_TRUE(contains(all, s));
    s = base, s.tool_distance = ToolDistance::kGrid, s.sdf_refinement = 4;
    EXPECT_TRUE(contains(all, s));
    s = base, s.precision = Precision::kDouble;
    EXPECT_TRUE(contains(all, s));
    s = base, s.iterations = 8;
    EXPECT_TRUE(contains(all, s));
    s = base, s.continuous_collision = false;
    EXPECT_TRUE(contains(all, s));
}

TEST(SceneWith, AsksForExactlyTheseSettings) {
    scene::Scene scene;
    scene.mutable_accuracy()->set_preset(scene::Accuracy::FAST);
    scene.mutable_accuracy()->set_switchable(false);
    for (const AccuracySettings& settings : sweepSettings(kOdd, true)) {
        const scene::Scene changed = sceneWith(scene, settings);
        EXPECT_EQ(accuracyOf(changed), settings) << settingsName(settings);
        EXPECT_FALSE(changed.accuracy().switchable());
    }
}

}  // namespace
}  // namespace bonemill
