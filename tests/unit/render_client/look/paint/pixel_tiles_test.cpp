#include "render_client/look/paint/pixel_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace bonemill {
namespace {

constexpr int kTilesWidth = 330, kTilesHeight = 210;  // no whole tiles

// How many of the boxes have each pixel.
std::vector<int> countsOf(const std::vector<PixelBox>& boxes) {
    std::vector<int> counts(size_t(kTilesWidth * kTilesHeight), 0);
    for (const PixelBox& box : boxes)
        for (int y = box.y0; y < box.y1; ++y)
            for (int x = box.x0; x < box.x1; ++x) ++counts.at(size_t(y * kTilesWidth + x));
    return counts;
}

TEST(PixelTiles, BoxesHaveEachPixelOfTheTilesOnce) {
    std::mt19937 random(5);
    const auto below = [&](int end) { return int(random() % unsigned(end)); };
    for (int n = 0; n < 50; ++n) {
        PixelTiles tiles(kTilesWidth, kTilesHeight);
        std::vector<PixelBox> added;
        for (int m = 0; m < 6; ++m) {
            const int x = below(400) - 40, y = below(300) - 40;
            added.push_back({x, y, x + below(120), y + below(90)});
            tiles.add(added.back());
        }
        const std::vector<int> counts = countsOf(tiles.boxes());
        for (int y = 0; y < kTilesHeight; ++y)
            for (int x = 0; x < kTilesWidth; ++x) {
                const int tile_x = x / PixelTiles::kTile, tile_y = y / PixelTiles::kTile;
                const PixelBox tile{tile_x * PixelTiles::kTile, tile_y * PixelTiles::kTile,
                                    (tile_x + 1) * PixelTiles::kTile, (tile_y + 1) * PixelTiles::kTile};
                const bool is_touched = std::ranges::any_of(added, [&](const PixelBox& box) {
                    return !box.isEmpty() &&
                           !box.within(tile).within(PixelBox::whole(kTilesWidth, kTilesHeight)).isEmpty();
                });
                ASSERT_EQ(counts[size_t(y * kTilesWidth + x)], is_touched ? 1 : 0) << x << " " << y;
            }
    }
}

TEST(PixelTiles, AreBoundedAndGrow) {
    PixelTiles tiles(kTilesWidth, kTilesHeight);
    EXPECT_TRUE(tiles.isEmpty());
    EXPECT_TRUE(tiles.bounds().isEmpty());
    tiles.add(PixelBox{40, 40, 41, 41});
    EXPECT_EQ(tiles.bounds(), (PixelBox{32, 32, 48, 48}));
    EXPECT_EQ(tiles.grown(1).bounds(), (PixelBox{16, 16, 64, 64}));
    EXPECT_EQ(tiles.grown(33).bounds(), (PixelBox{0, 0, 96, 96}));
    EXPECT_EQ(PixelTiles::whole(kTilesWidth, kTilesHeight).boxes(),
              std::vector<PixelBox>{PixelBox::whole(kTilesWidth, kTilesHeight)});
}

TEST(PixelTiles, ABoxIsSlicedAcrossItsLongestSide) {
    const Eigen::AlignedBox3f box(Eigen::Vector3f(0, -1, 0), Eigen::Vector3f(1, 3, 2));
    const auto slices = sliced(box, 4);
    ASSERT_EQ(slices.size(), 4u);
    for (size_t n = 0; n < 4; ++n) {
        EXPECT_FLOAT_EQ(slices[n].min().y(), float(n) - 1);
        EXPECT_FLOAT_EQ(slices[n].max().y(), float(n));
        EXPECT_EQ(slices[n].sizes().x(), 1);
    }
    EXPECT_TRUE(sliced(Eigen::AlignedBox3f(), 4).empty());
}

}  // namespace
}  // namespace bonemill
