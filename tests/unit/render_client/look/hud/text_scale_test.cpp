#include <gtest/gtest.h>

#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {
namespace {

TEST(TextScale, GrowsWithThePictureWhateverTheDesktopIsSetTo) {
    EXPECT_FLOAT_EQ(textScale(1280, 800), 1);
    EXPECT_FLOAT_EQ(textScale(3840, 2160), 2.7f) << "4K without desktop scaling";
    EXPECT_FLOAT_EQ(textScale(2560, 1600, 1, 2), 2);
    EXPECT_FLOAT_EQ(textScale(3840, 800), 1) << "the smaller side counts";
    EXPECT_FLOAT_EQ(textScale(640, 1600), 0.7f) << "it can still be read";
    EXPECT_FLOAT_EQ(textScale(640, 480, 1, 2), 1.4f) << "also where pixels are small";
}

TEST(TextScale, IsMultipliedByTheUsersOwnFactor) {
    EXPECT_FLOAT_EQ(textScale(1280, 800, 1.5), 1.5f);
    EXPECT_FLOAT_EQ(textScale(300, 200, 2), 1.4f);
}

}  // namespace
}  // namespace bonemill
