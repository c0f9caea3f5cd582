// Acquisitions, phases and reconstructions of one series are told apart by their headers alone.
#include "haptic_server/scans/dicom/dicom_parts.h"

#include <gtest/gtest.h>

#include "haptic_server/scans/dicom/dicom_series.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

using Value = std::string DicomTraits::*;

void addStack(std::vector<DicomSlice>& slices, int count, Value trait, const std::string& value) {
    for (int k = 0; k < count; ++k) {
        DicomSlice slice;
        slice.path = value + "_" + std::to_string(k);
        slice.series_uid = "1.2.3";
        slice.modality = "CT";
        slice.columns = slice.rows = 8;
        slice.position_mm = {0, 0, double(k)};
        slice.traits.*trait = value;
        slices.push_back(slice);
    }
}

DicomChoice choose(const std::vector<DicomSlice>& slices, const std::string& acquisition = {}) {
    return chooseStack(slices, {"", acquisition, ""}, "f", [](const auto&, const auto&) { return false; });
}

TEST(DicomParts, AnyTraitTellsThemApart) {
    struct Case {
        Value trait;
        const char *one, *other;
        const char* name;  // of the one
        const char* told_by;
    };
    for (const Case& c :
         {Case{&DicomTraits::acquisition_number, "1", "2", "1", "acquisition number"},
          Case{&DicomTraits::temporal_position, "9", "10", "phase 9", "temporal position"},
          Case{&DicomTraits::b_value, "0", "1000", "b 0", "b-value"},
          Case{&DicomTraits::kernel, "B70f", "B30f", "kernel B70f", "kernel"},
          Case{&DicomTraits::image_type, "ORIGINAL\\PRIMARY", "DERIVED\\PRIMARY", "type ORIGINAL/PRIMARY",
               "image type"},
          Case{&DicomTraits::acquisition_time, "101500", "101530", "time 101500", "acquisition time"},
          Case{&DicomTraits::content_time, "101500", "101530", "content time 101500", "content time"}}) {
        std::vector<DicomSlice> slices;
        addStack(slices, 6, c.trait, c.one);
        addStack(slices, 6, c.trait, c.other);
        std::swap(slices[2], slices[8]);
        const DicomChoice first = choose(slices);
        EXPECT_EQ(first.stack.name, c.name);
        EXPECT_EQ(first.stack.told_by, c.told_by);
        for (const DicomSlice& slice : first.stack.slices) EXPECT_EQ(slice.traits.*c.trait, c.one);
        addStack(slices, 7, c.trait, "7");
        const DicomChoice wished = choose(slices, c.name);
        EXPECT_EQ(wished.stack.name, c.name);
        EXPECT_EQ(wished.stack.slices.size(), 6u);
        const bool is_sharper = c.trait == &DicomTraits::kernel;
        EXPECT_EQ(choose(slices).stack.slices.size(), is_sharper ? 6u : 7u)
            << "most slices, else bone kernel";
    }
}

TEST(DicomParts, TheChoiceSaysWhichThereAreAndHowToTakeAnother) {
    std::vector<DicomSlice> slices;
    addStack(slices, 6, &DicomTraits::acquisition_number, "12");
    addStack(slices, 6, &DicomTraits::acquisition_number, "3");
    addStack(slices, 5, &DicomTraits::acquisition_number, "2");
    const DicomChoice choice = choose(slices);
    EXPECT_EQ(choice.how_chosen,
              "the series holds 3 stacks that overlap, told apart by acquisition number: 2 (5 slices); 3 "
              "(6 slices); 12 (6 slices); taken: 3; volume.acquisition (make-case: --acquisition) takes "
              "another");
    EXPECT_TRUE(choice.left_out.empty()) << choice.left_out;
    expectUserError([&] { choose(slices, "4"); }, {"f: holds no acquisition 4", "acquisition 12"});
}

TEST(DicomParts, TwoTraitsTellApartWhatOneCannot) {
    std::vector<DicomSlice> slices;
    for (const char* number : {"1", "2"})
        for (const char* kernel : {"B30f", "B70f"}) {
            const size_t before = slices.size();
            addStack(slices, 5, &DicomTraits::acquisition_number, number);
            for (size_t s = before; s < slices.size(); ++s) slices[s].traits.kernel = kernel;
        }
    const DicomStack first = choose(slices).stack;
    EXPECT_EQ(first.name, "1, kernel B70f") << "bone kernels are preferred";
    EXPECT_EQ(first.told_by, "acquisition number and kernel");
    EXPECT_EQ(choose(slices, "2, kernel B30f").stack.slices.front().traits.kernel, "B30f");
}

// Two ranges, not two acquisitions: a split would lose half of the bone.
TEST(DicomParts, AcquisitionsOfDifferentPlacesStayOneStack) {
    std::vector<DicomSlice> slices;
    addStack(slices, 5, &DicomTraits::acquisition_number, "1");
    addStack(slices, 5, &DicomTraits::acquisition_number, "2");
    for (size_t s = 5; s < 10; ++s) slices[s].position_mm.z() += 5;
    const DicomChoice choice = choose(slices);
    EXPECT_EQ(choice.stack.slices.size(), 10u);
    EXPECT_TRUE(choice.stack.name.empty());
    EXPECT_TRUE(choice.how_chosen.empty());
}

// One volume alternates neither kernels nor, where that makes it uneven, anything else.
TEST(DicomParts, StacksBetweenEachOthersSlicesAreToldApart) {
    for (const Value trait : {&DicomTraits::kernel, &DicomTraits::acquisition_number})
        for (const double offset_mm : {0.5, 0.25}) {
            std::vector<DicomSlice> slices;
            addStack(slices, 8, trait, "1");
            addStack(slices, 8, trait, "2");
            for (size_t s = 8; s < 16; ++s) slices[s].position_mm.z() += offset_mm;
            const bool is_one = trait == &DicomTraits::acquisition_number && offset_mm == 0.5;
            EXPECT_EQ(choose(slices).stack.slices.size(), is_one ? 16u : 8u) << offset_mm;
        }
}

TEST(DicomParts, NoPictureIsReadThatIsNotWanted) {
    std::vector<DicomSlice> slices;
    addStack(slices, 6, &DicomTraits::kernel, "1");
    addStack(slices, 6, &DicomTraits::kernel, "1");
    for (DicomSlice slice : std::vector(slices.begin(), slices.begin() + 5)) {
        slice.series_uid = "5.6";
        slices.push_back(slice);
    }
    const auto fail = [](const auto&, const auto&) -> bool { throw UserError("read"); };
    EXPECT_EQ(chooseStack(slices, {"5.6", "", ""}, "f", fail).stack.slices.size(), 5u);
    expectUserError([&] { chooseStack(slices, {"1.2.3", "", ""}, "f", fail); }, {"f: read"});
}

// The acquisition number would leave one stack with a gap; the phase leaves none.
TEST(DicomParts, TheSplitThatMakesProperStacksIsTaken) {
    std::vector<DicomSlice> slices;
    addStack(slices, 12, &DicomTraits::temporal_position, "1");
    addStack(slices, 12, &DicomTraits::temporal_position, "2");
    for (size_t s = 0; s < slices.size(); ++s)
        slices[s].traits.acquisition_number = s < 3 || (s >= 9 && s < 12) || s == 23 ? "1" : "2";
    for (size_t s = 12; s < 15; ++s) slices[s].traits.acquisition_number = "2";
    const DicomStack stack = choose(slices).stack;
    EXPECT_EQ(stack.told_by, "temporal position");
    EXPECT_EQ(stack.name, "phase 1");
}

TEST(DicomParts, TimesThatAllDifferTellNothing) {
    std::vector<DicomSlice> slices;
    addStack(slices, 6, &DicomTraits::content_time, "1");
    addStack(slices, 6, &DicomTraits::content_time, "2");
    for (size_t s = 0; s < slices.size(); ++s) slices[s].traits.content_time = std::to_string(s);
    const auto words = {std::string("same place and differ"), std::string("at each of 6 places"),
                        std::string("holds 2 acquisitions that nothing in the headers tells apart")};
    expectUserError([&] { choose(slices); }, words);
    for (size_t s = 0; s < slices.size(); ++s) slices[s].traits.content_time = std::to_string(s / 3);
    expectUserError([&] { choose(slices); }, words);
}

// To keep the files of one acquisition would leave one slice, or take away more than is wrong.
TEST(DicomParts, WhatToDoAboutSlicesAtOnePlaceIsTrue) {
    std::vector<DicomSlice> slices;
    addStack(slices, 6, &DicomTraits::content_time, "1");
    slices.push_back(slices[2]);
    slices.back().path = "astray";
    expectUserError([&] { choose(slices); },
                    {"1_2 at 2.000 mm and astray", "at 1 of 6 places", "Image Position"});
    for (DicomSlice& slice : slices) slice.position_mm.setZero();
    expectUserError([&] { choose(slices); },
                    {"all its 7 slices lie at the same place", "no volume", "take another series"});
    const auto alike = [](const auto&, const auto&) { return true; };
    expectUserError([&] { chooseStack(slices, {}, "f", alike); },
                    {"there is one", "6 copies of slices left out"});
}

// Each of them has a gap of its own.
TEST(DicomParts, AcquisitionsOfWhichNoneIsProperAreToldApartEvenSo) {
    std::vector<DicomSlice> slices;
    addStack(slices, 12, &DicomTraits::acquisition_number, "1");
    addStack(slices, 12, &DicomTraits::acquisition_number, "2");
    slices.erase(slices.begin() + 15, slices.begin() + 19);
    slices.erase(slices.begin() + 3, slices.begin() + 7);
    expectUserError([&] { choose(slices); }, {"4 slices are missing between 1_2"});
    expectUserError([&] { choose(slices, "2"); }, {"4 slices are missing between 2_2"});
}

// Scanners that step count every rotation of the gantry.
TEST(DicomParts, WhatSplitsIntoShortRangesGoesAfterWhatDoesNot) {
    std::vector<DicomSlice> slices;
    addStack(slices, 12, &DicomTraits::content_time, "1");
    addStack(slices, 12, &DicomTraits::content_time, "2");
    for (size_t s = 0; s < slices.size(); ++s) slices[s].traits.acquisition_number = std::to_string(s / 4);
    EXPECT_EQ(choose(slices).stack.slices.size(), 12u);
    for (DicomSlice& slice : slices) slice.traits.content_time.clear();
    EXPECT_EQ(choose(slices).stack.slices.size(), 4u);
}

TEST(DicomParts, StacksBesideEachOtherAreToldApart) {
    std::vector<DicomSlice> slices;
    addStack(slices, 8, &DicomTraits::acquisition_number, "1");
    addStack(slices, 8, &DicomTraits::acquisition_number, "2");
    for (size_t s = 8; s < 16; ++s) slices[s].position_mm += Eigen::Vector3d(30, 0, 0.5);
    EXPECT_EQ(choose(slices).stack.slices.size(), 8u);
}

TEST(DicomParts, StacksThatShareANumberAreCounted) {
    std::vector<DicomSlice> slices;
    addStack(slices, 6, &DicomTraits::acquisition_number, "1");
    addStack(slices, 8, &DicomTraits::acquisition_number, "1");
    for (size_t s = 6; s < 14; ++s) slices[s].columns = 16;
    EXPECT_EQ(choose(slices).stack.name, "1/2");
    EXPECT_EQ(choose(slices, "1/1").stack.slices.size(), 6u);
    EXPECT_EQ(choose(slices, "1").stack.slices.size(), 8u);
}

TEST(DicomParts, TheStackThatHoldsTheFileIsTaken) {
    std::vector<DicomSlice> slices;
    addStack(slices, 6, &DicomTraits::acquisition_number, "1");
    addStack(slices, 9, &DicomTraits::acquisition_number, "2");
    const auto differ = [](const auto&, const auto&) { return false; };
    EXPECT_EQ(chooseStack(slices, {"1.2.3", "", "1_4"}, "f", differ).stack.name, "1");
    EXPECT_EQ(chooseStack(slices, {"1.2.3", "2", "1_4"}, "f", differ).stack.name, "2");
}

}  // namespace
}  // namespace bonemill
