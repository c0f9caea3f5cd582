#include <gtest/gtest.h>

#include "render_client/look/slices/slice_image.h"

namespace bonemill {
namespace {

DensityGrid ctGrid(double low, double high, double iso) {
    return {{8, 8, 8}, {1e-3, 1e-3, 1e-3}, {0, 0, 0}, 8, low, high, iso};
}

TEST(GreyWindow, GoesFromBlackToWhite) {
    const GreyWindow bone{2000, 500};
    EXPECT_DOUBLE_EQ(greyOf(bone, -500), 0);
    EXPECT_DOUBLE_EQ(greyOf(bone, 500), 0.5);
    EXPECT_DOUBLE_EQ(greyOf(bone, 1000), 0.75);
    EXPECT_DOUBLE_EQ(greyOf(bone, 1500), 1);
    EXPECT_DOUBLE_EQ(greyOf(bone, 9000), 1);
    EXPECT_DOUBLE_EQ(greyOf(bone, -9000), 0);
}

TEST(GreyWindow, DensitiesAreValuesOfTheScan) {
    const DensityGrid grid = ctGrid(-1000, 3000, 300);
    EXPECT_DOUBLE_EQ(valueOf(grid, 0), -1000);
    EXPECT_DOUBLE_EQ(valueOf(grid, 65535), 3000);
    EXPECT_NEAR(densityOf(grid, 300), 1300 / 4000.0 * 65535, 1e-9);
    const std::vector<uint8_t> table = greyTable(grid, {1000, 500});
    ASSERT_EQ(table.size(), 65536u);
    EXPECT_EQ(table[0], 0);
    EXPECT_EQ(table[65535], 255);
    EXPECT_EQ(table[size_t(densityOf(grid, 500))], 127);
    EXPECT_EQ(table[size_t(densityOf(grid, 750))], 191);
}

TEST(GreyWindow, StartsWithBoneInTheUpperTwoThirds) {
    const GreyWindow wide = startWindow(ctGrid(-1000, 3000, 600));
    EXPECT_NEAR(greyOf(wide, 600), 1.0 / 3, 1e-9);
    EXPECT_DOUBLE_EQ(greyOf(wide, 3000), 1);
    EXPECT_LT(greyOf(wide, 2900), 1);
    const GreyWindow narrow = startWindow(ctGrid(-200, 1800, 300));
    EXPECT_EQ(narrow, (GreyWindow{2000, 800})) << "no wider than the scan";
}

TEST(GreyWindow, ADragMovesWidthAndLevel) {
    const DensityGrid grid = ctGrid(-1000, 3000, 600);
    const GreyWindow start{2000, 500};
    EXPECT_EQ(draggedWindow(start, grid, 0.25, 0), (GreyWindow{3000, 500}));
    EXPECT_EQ(draggedWindow(start, grid, 0, 0.25), (GreyWindow{2000, 1500}));
    EXPECT_GT(draggedWindow(start, grid, -50, 0).width, 0);
    EXPECT_LE(draggedWindow(start, grid, 50, 50).width, 8000);
    EXPECT_LE(draggedWindow(start, grid, 50, 50).level, 7000);
}

TEST(GreyWindow, IsWrittenAsRadiologistsDo) {
    EXPECT_EQ(textOf(GreyWindow{2000, 800}), "W 2000 L 800");
}

}  // namespace
}  // namespace bonemill
