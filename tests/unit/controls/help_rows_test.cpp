#include "render_client/controls/help_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "render_client/controls/key_table.h"

namespace bonemill {
namespace {

// "Right drag" is no row of the key Right.
bool names(const HudRow& row, std::string_view key) {
    if (row.label.find(" drag") != std::string::npos) return false;
    std::istringstream words(row.label);
    return std::find(std::istream_iterator<std::string>(words), {}, key) !=
           std::istream_iterator<std::string>();
}

std::vector<std::string> meaningsOf(std::string_view key, HelpFor whom = HelpFor::kHolding) {
    std::vector<std::string> meanings;
    for (const HudRow& row : helpRows(whom))
        if (names(row, key)) meanings.push_back(row.value);
    return meanings;
}

TEST(HelpRows, NameEveryKeyOfTheTableOnceWithItsMeaning) {
    const auto expect_named = [](const auto& binding) {
        EXPECT_FALSE(binding.meaning.empty()) << binding.label;
        EXPECT_EQ(meaningsOf(binding.label), std::vector{meaningOf(binding)}) << binding.label;
    };
    for (const KeyBinding& binding : keyTable()) expect_named(binding);
    for (const SignBinding& binding : signTable()) expect_named(binding);
}

TEST(HelpRows, WhatHoldsTheToolIsThereOnlyWhereAMouseCanHoldIt) {
    for (const KeyBinding& binding : keyTable()) {
        const bool begins = binding.action == Action::kHoldTool;
        EXPECT_EQ(meaningsOf(binding.label, HelpFor::kLooking).empty(), binding.is_of_hold) << binding.label;
        EXPECT_EQ(meaningsOf(binding.label, HelpFor::kMayHold).empty(), binding.is_of_hold && !begins)
            << binding.label;
    }
    EXPECT_EQ(holdRows().front().value, helpRows(HelpFor::kHolding).front().value);
}

TEST(HelpRows, KeysThatDoTheSameShareARow) {
    const std::vector<HudRow> rows = helpRows(HelpFor::kLooking);
    for (const char* keys : {"X Y Z", "Shift+X Shift+Y Shift+Z", "Left Right Up Down", "[ ]", "+ = -"})
        EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](const HudRow& r) { return r.label == keys; }))
            << keys;
}

TEST(HelpRows, TheDigitsSayWhichAccuracyTheyAskFor) {
    for (size_t key = 1; key < std::size(kAccuracyOfKey); ++key)
        EXPECT_EQ(meaningsOf(std::to_string(key)),
                  std::vector{"accuracy " + std::string(kAccuracyOfKey[key])});
}

}  // namespace
}  // namespace bonemill
