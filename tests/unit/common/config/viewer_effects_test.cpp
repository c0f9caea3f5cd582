#include "common/config/viewer_effects.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace bonemill {
namespace {

TEST(ViewerEffects, OfAllEffectsTheyAloneAreKept) {
    scene::Effects effects;
    const auto& reflection = *effects.GetReflection();
    const auto& type = *scene::Effects::descriptor();
    for (int n = 0; n < type.field_count(); ++n) reflection.MutableMessage(&effects, type.field(n));
    reflection.MutableUnknownFields(&effects)->AddVarint(1000, 1);
    keepViewerEffects(effects);

    std::set<std::string> kept;
    for (int n = 0; n < type.field_count(); ++n)
        if (reflection.HasField(effects, type.field(n))) kept.insert(type.field(n)->name());
    EXPECT_EQ(kept, (std::set<std::string>{"bone_dust", "bleeding", "irrigation", "burr_spin",
                                           "milling_sound", "browning", "bruising", "pulse"}));
    EXPECT_TRUE(reflection.GetUnknownFields(effects).empty());
}

}  // namespace
}  // namespace bonemill
