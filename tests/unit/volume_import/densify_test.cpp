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

}  // namespace
}  // namespace bonemill
