#include "haptic_server/volume/import/densify.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/volume_import/expect_user_error.h"

namespace bonemill {
namespace {

RawVolume rawOf(const Eigen::Vector3i& dims, float value) {
    RawVolume raw;
    raw.geometry.dims = dims;
    raw.geometry.spacing = {1e-3, 2e-3, 3e-3};
    raw.values.assign(raw.geometry.voxelCount(), value);
    return raw;
}

TEST(Densify, windowIsLinearAndClamped) {
    RawVolume raw = rawOf({3, 2, 2}, 0);
    const float values[] = {-2000, -1000, -500, 0, 500, 1000, 2000};
    std::copy(std::begin(values), std::end(values), raw.values.begin());
    raw.values[7] = std::numeric_limits<float>::quiet_NaN();
    raw.values[8] = std::numeric_limits<float>::infinity();
    raw.values[9] = -std::numeric_limits<float>::infinity();
    const VoxelVolume volume = densify(raw, DensityWindow{-1000.0, 1000.0, 500.0, 0});
    const Density expected[] = {0, 0, 16384, 32768, 49151, 65535, 65535, 0, 65535, 0};
    for (int n = 0; n < 10; ++n) EXPECT_EQ(volume.at(n % 3, n / 3 % 2, n / 6), expected[n]) << n;
    EXPECT_EQ(volume.iso(), 49151);
    EXPECT_EQ(volume.spacing(), raw.geometry.spacing);
}

TEST(Densify, windowDefaultsToTheRangeOfTheData) {
    RawVolume raw = rawOf({4, 4, 4}, 10);
    raw.values[0] = 110;
    raw.values[1] = std::numeric_limits<float>::quiet_NaN();
    const DensityMapping mapping = chooseMapping(raw, DensityWindow{{}, {}, 60.0, 0});
    EXPECT_EQ(mapping.low, 10);
    EXPECT_EQ(mapping.high, 110);
    EXPECT_EQ(mapping.iso, 32768);
    EXPECT_FALSE(mapping.is_iso_proposed);
    EXPECT_NEAR(mapping.raw(mapping.iso), 60, 1e-3);
}

TEST(Densify, isoMustLieInsideTheWindow) {
    const RawVolume raw = rawOf({4, 4, 4}, 10);
    for (const double iso : {-1.0, 0.0, 100.0, 101.0, std::numeric_limits<double>::quiet_NaN()})
        expectUserError([&] { densify(raw, DensityWindow{0.0, 100.0, iso, 0}); }, {"iso-value", "0 .. 100"});
    expectUserError([&] { densify(raw, DensityWindow{5.0, 5.0, 5.0, 0}); }, {"window", "empty"});
    expectUserError([&] { densify(raw, DensityWindow{7.0, 5.0, 6.0, 0}); }, {"window", "empty"});
    expectUserError([&] { densify(rawOf({4, 4, 4}, NAN), DensityWindow{}); }, {"no finite value"});
}

// Pieces of 1, 2 and 3 voxels; the last touches another only across an edge, which does not connect.
TEST(Densify, smallPiecesGoBelowTheSurface) {
    RawVolume raw = rawOf({6, 5, 4}, 0);
    const auto set = [&](int i, int j, int k) { raw.values[size_t(i + 6 * (j + 5 * k))] = 100; };
    set(0, 0, 0);
    set(2, 2, 1), set(2, 2, 2);
    set(4, 0, 3), set(5, 0, 3), set(5, 1, 3);
    set(4, 2, 3);  // edge neighbour of (5, 1, 3)
    VoxelVolume volume = densify(raw, DensityWindow{0.0, 200.0, 100.0, 0});
    const Density iso = volume.iso();
    const PieceCount count = removeSmallPieces(volume, 3);
    EXPECT_EQ(count.pieces_kept, 1u);
    EXPECT_EQ(count.pieces_removed, 3u);
    EXPECT_EQ(count.voxels_removed, 4u);
    EXPECT_EQ(volume.at(0, 0, 0), iso - 1);
    EXPECT_EQ(volume.at(2, 2, 2), iso - 1);
    EXPECT_EQ(volume.at(4, 2, 3), iso - 1);
    EXPECT_EQ(volume.at(5, 0, 3), iso);
    EXPECT_EQ(volume.at(1, 1, 1), 0);
}

}  // namespace
}  // namespace bonemill
