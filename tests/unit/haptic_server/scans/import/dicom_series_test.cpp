// Series are grouped and ordered from headers alone.
#include "haptic_server/scans/dicom/dicom_series.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

std::vector<DicomSlice> stackOf(int count, double step_mm) {
    std::vector<DicomSlice> slices;
    for (int k = 0; k < count; ++k) {
        DicomSlice slice;
        slice.path = std::string("slice") + std::to_string(k);
        slice.series_uid = "1.2.3";
        slice.columns = slice.rows = 8;
        slice.position_mm = {5, 6, 100 - k * step_mm};
        slices.push_back(slice);
    }
    return slices;
}

DicomChoice choiceOf(const std::vector<DicomSlice>& slices) {
    return chooseStack(slices, {}, "f", [](const auto&, const auto&) { return true; });
}

DicomStack chosen(const std::vector<DicomSlice>& slices) {
    return choiceOf(slices).stack;
}

TEST(DicomSeries, spacingIsTheMeanDistance) {
    auto slices = stackOf(11, 0.7);
    slices[5].position_mm.z() += 0.001;  // decimal text
    const DicomStack stack = chosen(slices);
    EXPECT_NEAR(stack.slice_spacing_mm, 0.7, 1e-12);
    EXPECT_EQ(stack.slices.front().path, "slice10");
    EXPECT_EQ(stack.slices.back().path, "slice0");
}

TEST(DicomSeries, scoutOfTheSameSeriesIsLeftOut) {
    auto slices = stackOf(5, 1);
    DicomSlice scout = slices[0];
    scout.path = "scout";
    scout.column_direction = {0, 0, -1};
    slices.push_back(scout);
    scout = slices[1];
    scout.columns = 16;
    slices.push_back(scout);
    const DicomChoice choice = choiceOf(slices);
    EXPECT_EQ(choice.stack.slices.size(), 5u);
    EXPECT_NE(choice.left_out.find("1 slices 16x8"), std::string::npos) << choice.left_out;
}

TEST(DicomSeries, PositionsRoundedToATenthAreTakenAsEven) {
    auto slices = stackOf(60, 0.625);
    for (DicomSlice& slice : slices) slice.position_mm.z() = std::round(10 * slice.position_mm.z()) / 10;
    const DicomStack stack = chosen(slices);
    EXPECT_TRUE(stack.places.empty());
    EXPECT_NEAR(stack.slice_spacing_mm, 0.625, 0.05 / 60);
    EXPECT_NE(stack.remark.find("rounded positions"), std::string::npos) << stack.remark;
}

TEST(DicomSeries, OtherDistancesAreResampledByTheirLeast) {
    auto slices = stackOf(6, 1);
    slices[5].position_mm.z() -= 0.4;
    const DicomStack last = chosen(slices);
    EXPECT_EQ(last.places.size(), 6u);
    EXPECT_NEAR(last.slice_spacing_mm, 1, 1e-12);
    EXPECT_NE(last.remark.find("slices 1 to 1.4 mm apart"), std::string::npos) << last.remark;
    EXPECT_NE(last.remark.find("off by up to 0.7 mm"), std::string::npos) << last.remark;
    for (size_t s = 3; s < 6; ++s) slices[s].position_mm.z() = 98 - 2.5 * double(s - 2);
    EXPECT_NEAR(chosen(slices).slice_spacing_mm, 1, 1e-12);
}

TEST(DicomSeries, AWideGapIsRefusedWithItsPlace) {
    auto slices = stackOf(12, 1);
    slices.erase(slices.begin() + 4, slices.begin() + 8);
    expectUserError([&] { chosen(slices); }, {"4 slices are missing", "slice8", "slice3", "5 mm apart"});
}

TEST(DicomSeries, CtGoesBeforeALargerSeriesOfAnotherKind) {
    auto slices = stackOf(6, 1);
    for (DicomSlice& slice : slices) slice.modality = "CT";
    for (DicomSlice slice : stackOf(30, 0.5)) {
        slice.series_uid = "9.9", slice.modality = "MR";
        slices.push_back(slice);
    }
    const DicomChoice choice = choiceOf(slices);
    EXPECT_EQ(choice.stack.slices.size(), 6u);
    EXPECT_NE(choice.left_out.find("30 slices 8x8 of MR series 9.9"), std::string::npos) << choice.left_out;
}

// 5.0499 and 5.0501 lie on both sides of where rounding would part them.
TEST(DicomSeries, RoundingDoesNotTearASeriesApart) {
    auto slices = stackOf(6, 1);
    for (size_t s = 0; s < slices.size(); ++s) {
        const double angle = 0.0005 + (s % 2 ? 1e-5 : -1e-5);
        slices[s].row_direction = {std::cos(angle), std::sin(angle), 0};
        slices[s].column_direction = {-std::sin(angle), std::cos(angle), 0};
        slices[s].pixel_spacing_mm.setConstant(0.50005 + (s % 2 ? 1e-6 : -1e-6));
    }
    EXPECT_EQ(chosen(slices).slices.size(), 6u);
}

TEST(DicomSeries, allSlicesLieWithinTheGrid) {
    std::vector<SlicePlace> places(4);
    for (size_t s = 0; s < 4; ++s) places[s].along_mm = std::array{0, 5, 10, 13}[s];
    const Eigen::Vector2i size(1, 1);
    const SliceGrid grid = gridAround(places, size, {1, 1}, 5);
    ASSERT_EQ(grid.dims.z(), 4);
    RawValues values;
    values.append(std::vector<int16_t>{0, 50, 100, 130});
    const RawValues resampled = resampleStack(values, places, size, grid);
    EXPECT_EQ(resampled[2], 100);
    EXPECT_EQ(resampled[3], 130);
    places[3].along_mm = 15;
    EXPECT_EQ(gridAround(places, size, {1, 1}, 5).dims.z(), 4) << "and none beyond";
}

TEST(DicomSeries, aTiltBeyondAnyGantryIsRefused) {
    auto slices = stackOf(6, 1);
    for (size_t s = 0; s < slices.size(); ++s) slices[s].position_mm.y() += 1.01 * double(s);
    expectUserError([&] { chosen(slices); }, {"f: ", "45.3 degrees", "gantry"});
}

TEST(DicomSeries, sidewaysShiftIsRefused) {
    auto slices = stackOf(6, 1);
    slices[3].position_mm.x() += 0.5;
    expectUserError([&] { chosen(slices); }, {"slice3", "sideways"});
}

TEST(DicomSeries, theShiftedSliceIsNamedWhereverItIs) {
    for (const size_t shifted : {0u, 3u, 9u}) {
        auto slices = stackOf(10, 1);
        slices[shifted].position_mm.x() += 0.5;
        expectUserError([&] { chosen(slices); }, {"f: slice" + std::to_string(shifted) + " is shifted"});
    }
}

void turn(DicomSlice& slice, double angle_deg) {
    const Eigen::Vector3d middle_mm = slice.middle_mm();
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(angle_deg * M_PI / 180, Eigen::Vector3d::UnitX()).toRotationMatrix();
    slice.row_direction = R * slice.row_direction;
    slice.column_direction = R * slice.column_direction;
    slice.position_mm = middle_mm + R * (slice.position_mm - middle_mm);
}

TEST(DicomSeries, aRotatedSliceIsNotSaidToBeMissing) {
    auto slices = stackOf(12, 1);
    for (DicomSlice& slice : slices) slice.columns = slice.rows = 400;
    turn(slices[4], 2.5);
    const DicomStack stack = chosen(slices);
    EXPECT_EQ(stack.slices.size(), 11u);
    EXPECT_NE(stack.remark.find("slice4 is rotated by 2.5 degrees"), std::string::npos) << stack.remark;
    turn(slices[5], 2.5), turn(slices[6], 2.5);
    try {
        chosen(slices);
        ADD_FAILURE() << "no error";
    } catch (const UserError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("slice5 is rotated by 2.5 degrees"), std::string::npos) << message;
        EXPECT_EQ(message.find("missing"), std::string::npos) << message;
    }
    slices.erase(slices.begin() + 7);
    expectUserError([&] { chosen(slices); }, {"slice4 is rotated", "and 1 slices are missing"});
}

TEST(DicomSeries, ASliceThatIsUpsideDownIsNotSaidToBeMissing) {
    auto slices = stackOf(12, 1);
    turn(slices[4], 180);
    EXPECT_NE(chosen(slices).remark.find("slice4 is rotated by 180 degrees"), std::string::npos)
        << chosen(slices).remark;
}

TEST(DicomSeries, ASliceOfAnotherSizeIsNotSaidToBeMissing) {
    auto slices = stackOf(12, 1);
    slices[4].columns = 16;
    EXPECT_NE(chosen(slices).remark.find("slice4 has 16x8 pixels, the others 8x8"), std::string::npos);
}

TEST(DicomSeries, tiltAndGapAreSaidTogether) {
    auto slices = stackOf(12, 1);
    for (size_t s = 0; s < slices.size(); ++s) slices[s].position_mm.y() += 0.2 * double(s);
    slices.erase(slices.begin() + 4, slices.begin() + 8);
    expectUserError([&] { chosen(slices); }, {"4 slices are missing", "tilted by 11.31 degrees"});
    for (DicomSlice& slice : slices) slice.position_mm.y() *= 20;
    expectUserError([&] { chosen(slices); }, {"4 slices are missing", "degrees off their normal"});
}

TEST(DicomSeries, framesOfOneFileAreNamed) {
    auto slices = stackOf(4, 1);
    for (int k = 0; k < 4; ++k) {
        slices[size_t(k)].path = "multi.dcm";
        slices[size_t(k)].frame = k;
    }
    slices[3].position_mm = slices[2].position_mm;
    expectUserError([&] { chooseStack(slices, {}, "f", [](const auto&, const auto&) { return false; }); },
                    {"multi.dcm frame 3", "multi.dcm frame 4", "at 1 of 3 places"});
    EXPECT_EQ(chosen(slices).slices.size(), 3u) << "a copy";
}

}  // namespace
}  // namespace bonemill
