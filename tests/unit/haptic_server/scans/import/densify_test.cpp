#include "haptic_server/scans/densify/densify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/whole_densities.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

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
    const VoxelVolume volume = densify(raw, DensityWindow{-1000.0, 1000.0, 500.0});
    const Density expected[] = {0, 0, 16384, 32768, 49151, 65535, 65535, 0, 65535, 0};
    for (int n = 0; n < 10; ++n) EXPECT_EQ(volume.at(n % 3, n / 3 % 2, n / 6), expected[n]) << n;
    EXPECT_EQ(volume.iso(), 49151);
    EXPECT_EQ(volume.spacing(), raw.geometry.spacing);
}

TEST(Densify, windowDefaultsToTheRangeOfTheData) {
    const RawVolume raw = rawOf({4, 4, 4}, {110, std::numeric_limits<float>::quiet_NaN()}, 10);
    const DensityMapping mapping = chooseMapping(raw, DensityWindow{{}, {}, 60.0});
    EXPECT_EQ(mapping.low, 10);
    EXPECT_EQ(mapping.high, 110);
    EXPECT_EQ(mapping.iso, 32768);
    EXPECT_FALSE(mapping.proposed.has_value());
    EXPECT_NEAR(mapping.raw(mapping.iso), 60, 1e-3);
}

TEST(Densify, isoMustLieInsideTheWindow) {
    const RawVolume raw = rawOf({4, 4, 4}, 10);
    for (const double iso : {-1.0, 0.0, 100.0, 101.0, std::numeric_limits<double>::quiet_NaN()})
        expectUserError([&] { densify(raw, DensityWindow{0.0, 100.0, iso}); }, {"iso-value", "0 .. 100"});
    expectUserError([&] { densify(raw, DensityWindow{5.0, 5.0, 5.0}); }, {"window", "empty"});
    expectUserError([&] { densify(raw, DensityWindow{7.0, 5.0, 6.0}); }, {"window", "empty"});
    expectUserError([&] { densify(rawOf({4, 4, 4}, NAN), DensityWindow{}); }, {"no finite value"});
}

// A bone in tissue that is nowhere the same. The values are given back slice by slice; slices here are larger
// than a page, and layers of bricks several.
template <class T>
void expectTheSameNearBone() {
    const Eigen::Vector3i dims(120, 60, 90);
    std::vector<T> values;
    forEachIndex({Eigen::Vector3i::Zero(), dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const bool is_bone = (v - Eigen::Vector3i(25, 30, 40)).cast<double>().norm() < 9.3;
        values.push_back(T((is_bone ? 180 : 20) + (v.x() * 7 + v.y() * 13 + v.z() * 29) % 61));
    });
    RawVolume raw;
    raw.geometry.dims = dims;
    raw.values.append(std::span<const T>(values));
    const DensityMapping mapping = chooseMapping(raw, DensityWindow{{}, {}, 150.0});
    VoxelVolume expected(raw.geometry, mapping.iso);
    expected.fill([&](int i, int j, int k) {
        return mapping.density(double(values[size_t(i) + 120 * (size_t(j) + 60 * size_t(k))]));
    });
    const size_t all = expected.bricks().ownCount();
    clearFarFromBone(expected);
    const VoxelVolume kept = densifyNearBone(raw, mapping), given = densifyNearBone(std::move(raw), mapping);
    ASSERT_LT(expected.bricks().ownCount(), all);
    for (const VoxelVolume* volume : {&kept, &given}) {
        EXPECT_EQ(volume->bricks().ownCount(), expected.bricks().ownCount());
        for (BrickId brick = 0; brick < expected.bricks().brickCount(); ++brick)
            ASSERT_TRUE(std::equal(expected.bricks().contents(brick),
                                   expected.bricks().contents(brick) + kBrickSize,
                                   volume->bricks().contents(brick)))
                << brick;
    }
}

TEST(Densify, NearBoneItIsWhatIsLeftWhenTheRestIsCleared) {
    expectTheSameNearBone<uint8_t>();
    expectTheSameNearBone<int16_t>();
    expectTheSameNearBone<uint16_t>();
    expectTheSameNearBone<float>();
}

TEST(Densify, IntegersHaveTheDensitiesOfFloats) {
    std::vector<int16_t> integers;
    for (int value = -32768; value < 32768; ++value) integers.push_back(int16_t(value));
    RawVolume raw;
    raw.geometry.dims = {64, 32, 32};
    raw.values.append(std::span<const int16_t>(integers));
    const DensityMapping mapping = chooseMapping(raw, DensityWindow{-777.3, 2345.6, 250.0});
    const VoxelVolume volume = densify(raw, mapping);
    for (int n = 0; n < 65536; ++n)
        ASSERT_EQ(volume.at(n % 64, n / 64 % 32, n / 2048), mapping.density(n - 32768)) << n;
}

}  // namespace
}  // namespace bonemill
