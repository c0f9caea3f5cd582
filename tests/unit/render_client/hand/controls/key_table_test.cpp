#include "render_client/hand/controls/key_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

TEST(KeyTable, EveryKeyFindsItsAction) {
    for (const KeyBinding& binding : keyTable()) {
        const KeyEvent event{binding.key, true, false, {binding.with_shift, false}};
        EXPECT_EQ(actionOf(event), binding.action) << binding.label;
    }
    for (const SignBinding& binding : signTable())
        EXPECT_EQ(actionOf(TextEvent{binding.sign}), binding.action) << binding.label;
}

TEST(KeyTable, NoKeyMeansTwoThings) {
    std::set<std::pair<Key, bool>> keys;
    for (const KeyBinding& binding : keyTable())
        EXPECT_TRUE(keys.insert({binding.key, binding.with_shift}).second) << binding.label;
}

TEST(KeyTable, OnlyWhatMovesThingsRepeats) {
    EXPECT_EQ(actionOf(KeyEvent{Key::kLeft, true, true, {}}), Action::kOrbitLeft);
    EXPECT_FALSE(actionOf(KeyEvent{keyOf('T'), true, true, {}}));
    EXPECT_FALSE(actionOf(KeyEvent{keyOf('C'), true, true, {}}));
}

TEST(KeyTable, ReleasesControlAndForeignKeysDoNothing) {
    EXPECT_FALSE(actionOf(KeyEvent{keyOf('C'), false, false, {}}));
    EXPECT_FALSE(actionOf(KeyEvent{keyOf('C'), true, false, {false, true}}));
    EXPECT_FALSE(actionOf(KeyEvent{keyOf('W'), true, false, {true, false}}));
    EXPECT_FALSE(actionOf(KeyEvent{Key::kNone, true, false, {}}));
    EXPECT_FALSE(actionOf(TextEvent{U'c'}));
}

TEST(KeyTable, TheManualListsEveryKey) {
    std::ifstream file(test::sourceDir() + "/docs/reference/viewer.md");
    const std::string manual{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    ASSERT_FALSE(manual.empty());
    const auto is_listed = [&](std::string_view label) {
        return manual.find("`" + std::string(label) + "`") != std::string::npos;
    };
    for (const KeyBinding& binding : keyTable()) EXPECT_TRUE(is_listed(binding.label)) << binding.label;
    for (const SignBinding& binding : signTable()) EXPECT_TRUE(is_listed(binding.label)) << binding.label;
}

TEST(KeyTable, TheDigitsAskForTheSceneAndForEveryPresetOfTheServer) {
    ASSERT_EQ(std::size(kAccuracyOfKey), 1 + std::size(kPresets));
    EXPECT_EQ(accuracyOf(Action::kAccuracyScene), "scene");
    EXPECT_EQ(accuracyOf(Action::kAccuracy4), "exact");
    EXPECT_EQ(accuracyOf(Action::kWatchers), "");
    EXPECT_EQ(accuracyOf(Action::kNextTool), "");
    for (size_t n = 0; n < std::size(kPresets); ++n)
        EXPECT_EQ(kAccuracyOfKey[1 + n], presetName(kPresets[n]));
}

TEST(KeyTable, ControlsAndNoticesNameTheKey) {
    EXPECT_EQ(withKey("Figures", Action::kHud), "Figures (Tab)");
    EXPECT_EQ(keyLabelOf(Action::kFlipY), "Shift+Y");
    EXPECT_TRUE(isKeyOf(Action::kPoint, KeyEvent{keyOf('L'), false, false, {}}));
    EXPECT_FALSE(isKeyOf(Action::kPoint, KeyEvent{keyOf('K'), false, false, {}}));
}

}  // namespace
}  // namespace bonemill
