#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "render_client/hand/controls/key_table.h"

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
    for (const HelpGroup& group : helpGroups(whom))
        for (const HudRow& row : group.rows)
            if (names(row, key)) meanings.push_back(row.value);
    return meanings;
}

TEST(HelpRows, ModesSayWhichKeyLeavesThem) {
    ViewSettings settings;
    EXPECT_TRUE(modeTexts(settings).empty());
    settings.cuts[1].is_on = true;
    settings.camera = CameraMode::kEndoscope;
    EXPECT_EQ(modeTexts(settings), (std::vector<std::string>{"Endoscope (E: back)", "Cut Y on (Y: off)"}));
    settings.camera = CameraMode::kMicroscope;
    EXPECT_EQ(modeTexts(settings)[0], "Microscope (Shift+E: back)");
}

TEST(HelpRows, NameEveryKeyOfTheTableOnceWithItsMeaning) {
    const auto expect_named = [](const auto& binding) {
        EXPECT_FALSE(binding.meaning.empty()) << binding.label;
        EXPECT_EQ(meaningsOf(binding.label), std::vector{meaningOf(binding)}) << binding.label;
    };
    for (const KeyBinding& binding : keyTable())
        if (!binding.is_of_lesson && !binding.is_of_replay) expect_named(binding);
    for (const SignBinding& binding : signTable()) expect_named(binding);
}

TEST(HelpRows, WhatHoldsTheToolIsThereOnlyWhereAMouseCanHoldIt) {
    for (const KeyBinding& binding : keyTable()) {
        if (binding.is_of_lesson) {
            EXPECT_TRUE(meaningsOf(binding.label).empty()) << binding.label << ": there is no lesson";
            continue;
        }
        if (binding.is_of_replay) {
            EXPECT_TRUE(meaningsOf(binding.label).empty()) << binding.label << ": it is live";
            EXPECT_EQ(meaningsOf(binding.label, HelpFor::kReplay), std::vector{meaningOf(binding)});
            continue;
        }
        const bool begins = binding.action == Action::kHoldTool;
        EXPECT_EQ(meaningsOf(binding.label, HelpFor::kLooking).empty(), binding.is_of_hold) << binding.label;
        EXPECT_EQ(meaningsOf(binding.label, HelpFor::kMayHold).empty(), binding.is_of_hold && !begins)
            << binding.label;
    }
    EXPECT_EQ(hintRows().back().label, keyLabelOf(Action::kHelp));
}

TEST(HelpRows, ALessonsKeysAreThereInALesson) {
    std::string all;
    for (const HelpGroup& group : helpGroups(HelpFor::kLooking, true))
        for (const HudRow& row : group.rows) all += row.label + "; ";
    for (const KeyBinding& binding : keyTable())
        EXPECT_TRUE(!binding.is_of_lesson || all.find(binding.label) != std::string::npos) << binding.label;
}

TEST(HelpRows, KeysThatDoTheSameShareARow) {
    std::vector<std::string> labels;
    for (const HelpGroup& group : helpGroups(HelpFor::kLooking))
        for (const HudRow& row : group.rows) labels.push_back(row.label);
    for (const char* keys : {"X Y Z", "Shift+X Shift+Y Shift+Z", "Left Right Up Down", "[ ]", "+ = -"})
        EXPECT_NE(std::ranges::find(labels, keys), labels.end()) << keys;
}

TEST(HelpRows, GroupsSayWhatKeysAreFor) {
    const auto groups = helpGroups(HelpFor::kLooking);
    const auto groupOfKey = [&](std::string_view key) -> std::string {
        for (const HelpGroup& group : groups)
            for (const HudRow& row : group.rows)
                if (names(row, key)) return group.title;
        return "";
    };
    EXPECT_EQ(groupOfKey("T"), "View");
    EXPECT_EQ(groupOfKey("-"), "View");
    EXPECT_EQ(groupOfKey("]"), "Cut-planes, scan");
    EXPECT_EQ(groupOfKey("C"), "Session");
    EXPECT_EQ(groupOfKey("4"), "Session");
    EXPECT_EQ(groupOfKey("M"), "Screen");
    EXPECT_EQ(groupOfKey("Esc"), "Screen");
    EXPECT_EQ(groups.size(), 6u) << "no tool to hold";
    EXPECT_EQ(helpGroups(HelpFor::kMayHold).size(), 7u);
}

TEST(HelpRows, TheFirstHintNamesHelpAndPanel) {
    const auto rows = startRows();
    ASSERT_GE(rows.size(), 2u);
    EXPECT_EQ(rows[0].label, keyLabelOf(Action::kHelp));
    EXPECT_EQ(rows[1].label, keyLabelOf(Action::kPanel));
}

TEST(HelpRows, TheDigitsSayWhichAccuracyTheyAskFor) {
    for (size_t key = 1; key < std::size(kAccuracyOfKey); ++key)
        EXPECT_EQ(meaningsOf(std::to_string(key)),
                  std::vector{"accuracy " + std::string(kAccuracyOfKey[key])});
}

}  // namespace
}  // namespace bonemill
