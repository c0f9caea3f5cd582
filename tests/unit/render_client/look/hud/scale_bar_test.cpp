#include <gtest/gtest.h>

#include "render_client/look/hud/hud_layout.h"

namespace bonemill {
namespace {

TEST(ScaleBar, IsTheLongestRoundLengthThatFits) {
    EXPECT_DOUBLE_EQ(makeScaleBar(1e-5, 250).length, 2e-3);
    EXPECT_EQ(makeScaleBar(1e-5, 250).label, "2 mm");
    EXPECT_EQ(makeScaleBar(1e-5, 99).label, "0.5 mm");
    EXPECT_EQ(makeScaleBar(1e-3, 60).label, "50 mm");
    EXPECT_EQ(makeScaleBar(1e-5, 100).label, "1 mm");
    EXPECT_EQ(makeScaleBar(0, 100).length, 0);
}

}  // namespace
}  // namespace bonemill
