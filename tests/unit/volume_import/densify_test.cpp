#include "haptic_server/volume/import/densify.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/volume_import/expect_user_error.h"

namespace bonemill {
namespace {

// The `first` values come first, then `rest` until the volume is full.
RawVolume rawOf(const Eigen::Vector3i& dims, std::vector<float> first, float rest) {
    RawVolume raw;
    raw.geometry.dims = dims;
    raw.geometry.spacing = {1e-3, 2e-3, 3e-3};
    first.resize(raw.geometry.voxelCount(), rest);
    raw.values.append(std::move(first));
    return raw;
}
RawVolume rawOf(const Eigen::Vector3i& dims, float value) {
    return rawOf(dims, {}, value);
}

TEST(Densify, windowIsLinearAndClamped) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    const RawVolume raw =
        rawOf({3, 2, 2}, {-2000, -1000, -500, 0, 500, 1000, 2000, kNan, kInfinite, -kInfinite}, 0);
    const VoxelVolume volume = densify(raw, DensityWindow{-1000.0, 1000.0, 500.0, 0});
    const Density expected[] = {0, 0, 16384, 32768, 49151, 65535, 65535, 0, 65535, 0};
    for (int n = 0; n < 10; ++n) EXPECT_EQ(volume.at(n % 3, n / 3 % 2, n / 6), expected[n]) << n;
    EXPECT_EQ(volume.iso(), 49151);
    EXPECT_EQ(volume.spacing(), raw.geometry.spacing);
}

TEST(Densify, windowDefaultsToTheRangeOfTheData) {
    const RawVolume raw = rawOf({4, 4, 4}, {110, std::numeric_limits<float>::quiet_NaN()}, 10);
    const DensityMapping mapping = chooseMapping(raw, DensityWindow{{}, {}, 60.0, 0});
    EXPECT_EQ(mapping.low, 10);
    EXPECT_EQ(mapping.high, 110);
    EXPECT_EQ(mapping.iso, 32768);
    EXPECT_FALSE(mapping.proposed.has_value());
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

// The values are given back slice by slice; slices here are larger than a page, and layers of bricks several.
TEST(Densify, valuesThatAreGivenBackAreTheSame) {
    std::vector<float> values;
    for (int n = 0; n < 70 * 60 * 50; ++n) values.push_back(float(n % 1009));
    RawVolume raw = rawOf({70, 60, 50}, values, 0);
    const DensityMapping mapping = chooseMapping(raw, DensityWindow{{}, {}, 500.0, 0});
    const VoxelVolume kept = densify(raw, mapping), given = densify(std::move(raw), mapping);
    for (int k = 0; k < 50; ++k)
        for (int j = 0; j < 60; ++j)
            for (int i = 0; i < 70; ++i) ASSERT_EQ(given.at(i, j, k), kept.at(i, j, k));
}

}  // namespace
}  // namespace bonemill
