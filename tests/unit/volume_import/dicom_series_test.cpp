// Series are grouped and ordered from headers alone.
#include "haptic_server/volume/import/dicom_series.h"

#include <gtest/gtest.h>

#include "tests/unit/volume_import/expect_user_error.h"

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

TEST(DicomSeries, spacingIsTheMeanDistance) {
    auto slices = stackOf(11, 0.7);
    slices[5].position_mm.z() += 0.001;  // decimal text
    const DicomStack stack = chooseStack(slices, "", "f");
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
    const DicomStack stack = chooseStack(slices, "", "f");
    EXPECT_EQ(stack.slices.size(), 5u);
    EXPECT_NE(stack.left_out.find("1 slices 16x8"), std::string::npos) << stack.left_out;
}

TEST(DicomSeries, unevenSpacingNamesThePlace) {
    auto slices = stackOf(6, 1);
    slices[5].position_mm.z() -= 0.4;
    expectUserError([&] { chooseStack(slices, "", "f"); }, {"uneven", "slice5", "slice4", "1.4 mm"});
}

TEST(DicomSeries, sidewaysShiftIsRefused) {
    auto slices = stackOf(6, 1);
    slices[3].position_mm.x() += 0.5;
    expectUserError([&] { chooseStack(slices, "", "f"); }, {"slice3", "sideways"});
}

TEST(DicomSeries, framesOfOneFileAreNamed) {
    auto slices = stackOf(4, 1);
    for (int k = 0; k < 4; ++k) {
        slices[size_t(k)].path = "multi.dcm";
        slices[size_t(k)].frame = k;
    }
    slices[3].position_mm = slices[2].position_mm;
    expectUserError([&] { chooseStack(slices, "", "f"); }, {"multi.dcm frame 3", "multi.dcm frame 4"});
}

}  // namespace
}  // namespace bonemill
