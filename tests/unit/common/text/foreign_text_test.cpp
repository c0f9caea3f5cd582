// What people cannot see for what it is goes into no name, note or log.
#include "common/text/foreign_text.h"

#include <gtest/gtest.h>

#include <vector>

namespace bonemill {
namespace {

std::string utf8Of(char32_t c) {
    const auto tail = [c](int shift) { return char(0x80 | ((c >> shift) & 0x3f)); };
    if (c < 0x80) return {char(c)};
    if (c < 0x800) return {char(0xc0 | c >> 6), tail(0)};
    if (c < 0x10000) return {char(0xe0 | c >> 12), tail(6), tail(0)};
    return {char(0xf0 | c >> 18), tail(12), tail(6), tail(0)};
}

bool isOneOf(char32_t c, const std::vector<std::pair<char32_t, char32_t>>& ranges) {
    for (const auto& [first, last] : ranges)
        if (c >= first && c <= last) return true;
    return false;
}

TEST(ForeignText, EveryCharacterIsJudgedAsItsTableSays) {
    const std::vector<std::pair<char32_t, char32_t>> unprintable{
        {0, 0x1f},        {0x7f, 0x9f},     {0xad, 0xad},     {0x61c, 0x61c},
        {0x180e, 0x180e}, {0x200b, 0x200b}, {0x200e, 0x200f}, {0x2028, 0x202e},
        {0x2060, 0x206f}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb}, {0xe0000, 0xe007f}};
    for (char32_t c = 0; c < 0x110000; ++c) {
        if (c >= 0xd800 && c < 0xe000) continue;  // no characters
        const std::string text = utf8Of(c);
        const bool is_bad = isOneOf(c, unprintable);
        ASSERT_EQ(hasUnprintable("a" + text + "b"), is_bad) << std::hex << uint32_t(c);
        ASSERT_EQ(printableLine("a" + text + "b"), is_bad ? "a?b" : "a" + text + "b")
            << std::hex << uint32_t(c);
    }
}

TEST(ForeignText, WhatIsCutOffIsNoLetter) {
    EXPECT_EQ(printableLine("a\xe2\x80"), "a\xe2\x80") << "read within the text";
    EXPECT_EQ(printableLine("gr\xc3\xbcn", 3), "gr...");
    EXPECT_EQ(printableLine("Anna\xe2\x80\xaegpj.exe"), "Anna?gpj.exe");
}

}  // namespace
}  // namespace bonemill
