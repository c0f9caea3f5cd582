#include "render_client/controls/accuracy_keys.h"

#include <gtest/gtest.h>

#include <iterator>

#include "haptic_server/accuracy/accuracy_settings.h"

namespace bonemill {
namespace {

TEST(AccuracyKeys, AskForTheSceneAndForEveryPresetOfTheServer) {
    ASSERT_EQ(std::size(kAccuracyOfKey), 1 + std::size(kPresets));
    EXPECT_EQ(kAccuracyOfKey[0], "scene");
    for (size_t n = 0; n < std::size(kPresets); ++n)
        EXPECT_EQ(kAccuracyOfKey[1 + n], presetName(kPresets[n]));
}

}  // namespace
}  // namespace bonemill
