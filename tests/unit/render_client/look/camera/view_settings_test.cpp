#include "render_client/look/camera/view_settings.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

TEST(ViewSettings, WhatWasChosenOfOneScenesAnatomyIsForgottenInTheNext) {
    ViewSettings settings;
    settings.structures.fill(StructureMode::kExposedOnly);
    settings.structures[3] = StructureMode::kOff;
    settings.slices.are_shown = true;
    settings.slices.positions[1] = 0.07;
    settings.slices.zoom = 4;
    settings.cuts[1] = {true, 0.35, true};
    settings.slices.window = GreyWindow{2000, 800};
    settings.forgetScene();
    EXPECT_EQ(settings.structures[3], StructureMode::kExposedOnly) << "as all others are";
    EXPECT_FALSE(settings.slices.positions[1] || settings.slices.window);
    EXPECT_EQ(settings.slices.zoom, 1);
    EXPECT_TRUE(settings.slices.are_shown);
    EXPECT_FALSE(settings.cuts[1].is_on || settings.cuts[1].is_flipped);
}

}  // namespace
}  // namespace bonemill
