#include <gtest/gtest.h>

#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {
namespace {

using CodePoints = std::vector<uint32_t>;

TEST(DecodeUtf8, OneToFourBytes) {
    EXPECT_EQ(decodeUtf8("a\u00b5\u2013\U0001F600"), (CodePoints{'a', 0xb5, 0x2013, 0x1f600}));
    EXPECT_TRUE(decodeUtf8("").empty());
}

TEST(DecodeUtf8, BrokenBytesBecomeTheReplacementSign) {
    EXPECT_EQ(decodeUtf8("\xff"
                         "a"),
              (CodePoints{0xfffd, 'a'}));
    EXPECT_EQ(decodeUtf8("a\xc2"), (CodePoints{'a', 0xfffd}));
    EXPECT_EQ(decodeUtf8("\xe2\x80"
                         "b"),
              (CodePoints{0xfffd, 0xfffd, 'b'}));
}

}  // namespace
}  // namespace bonemill
