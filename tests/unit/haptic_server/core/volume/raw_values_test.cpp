#include "haptic_server/core/volume/raw_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace bonemill {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

RawValues valuesOf(std::vector<float> samples) {
    RawValues values;
    values.append(std::move(samples));
    return values;
}

template <class T>
bool isHeldAs(const RawValues& values) {
    return values.visit([]<class Held>(std::span<const Held>) { return std::is_same_v<Held, T>; });
}

TEST(RawValues, floatsAreHeldAsTheNarrowestTypeThatHasThemAll) {
    EXPECT_TRUE(isHeldAs<uint8_t>(valuesOf({0, 255})));
    EXPECT_TRUE(isHeldAs<int16_t>(valuesOf({0, 256})));
    EXPECT_TRUE(isHeldAs<int16_t>(valuesOf({-1, 255})));
    EXPECT_TRUE(isHeldAs<int16_t>(valuesOf({-32768, 32767})));
    EXPECT_TRUE(isHeldAs<uint16_t>(valuesOf({0, 65535})));
    for (const float odd : {-32769.0f, 65536.0f, 0.5f, 1e30f, kNan, kInfinite, -kInfinite})
        EXPECT_TRUE(isHeldAs<float>(valuesOf({0, odd}))) << odd;
    EXPECT_TRUE(isHeldAs<float>(valuesOf({-1, 65535})));
}

TEST(RawValues, integersKeepTheirType) {
    RawValues values;
    values.append(std::vector<uint16_t>{1, 2});
    EXPECT_TRUE(isHeldAs<uint16_t>(values));
    const std::vector<uint8_t> more = {3};
    values.append(std::span(more.begin(), more.end()));
    EXPECT_TRUE(isHeldAs<uint16_t>(values));
    EXPECT_EQ(values, valuesOf({1, 2, 3}));
}

// Every step needs a wider type than the last; nothing that is there may change by it.
TEST(RawValues, typeBecomesWiderWhenItHasTo) {
    RawValues values;
    std::vector<float> all;
    const auto addAndCompare = [&]<class T>(std::vector<T> samples) {
        all.insert(all.end(), samples.begin(), samples.end());
        values.append(std::move(samples));
        ASSERT_EQ(values.size(), all.size());
        for (size_t n = 0; n < all.size(); ++n)
            EXPECT_TRUE(values[n] == all[n] || (std::isnan(values[n]) && std::isnan(all[n]))) << n;
    };
    addAndCompare(std::vector<uint8_t>{0, 255});
    addAndCompare(std::vector<uint16_t>{40000});
    EXPECT_TRUE(isHeldAs<uint16_t>(values));
    addAndCompare(std::vector<int16_t>{-1024, 3000});
    EXPECT_TRUE(isHeldAs<float>(values));
    addAndCompare(std::vector<float>{0.25f, kNan, -kInfinite});
    addAndCompare(std::vector<uint8_t>{7});
}

TEST(RawValues, rangeIsThatOfTheFiniteValues) {
    const RawValues none = valuesOf({kNan, kInfinite});
    EXPECT_GT(none.range().low, none.range().high);
    const RawValues some = valuesOf({3, kNan, -2, kInfinite, 8, -kInfinite});
    EXPECT_EQ(some.range().low, -2);
    EXPECT_EQ(some.range().high, 8);
    EXPECT_EQ(some.range().non_finite, 3u);
    EXPECT_TRUE(some.range().are_integers);
    EXPECT_FALSE(valuesOf({3, 2.5}).range().are_integers);
    RawValues grown = valuesOf({1, 2});
    grown.append(std::vector<int16_t>{-5});
    EXPECT_EQ(grown.range().low, -5);
    EXPECT_EQ(grown.range().high, 2);
}

TEST(RawValues, equalityIsOfValuesAndNotOfTypes) {
    RawValues wide;
    wide.append(std::vector<uint16_t>{1, 2, 3});
    EXPECT_EQ(wide, valuesOf({1, 2, 3}));
    EXPECT_NE(wide, valuesOf({1, 2, 4}));
    EXPECT_NE(wide, valuesOf({1, 2}));
}

TEST(RawValues, blocksAreReversedGroupByGroup) {
    RawValues values = valuesOf({0, 1, 10, 11, 20, 21, /**/ 50, 51, 60, 61, 70, 71});
    values.reverseBlocks(2, 3);
    EXPECT_EQ(values, valuesOf({20, 21, 10, 11, 0, 1, /**/ 70, 71, 60, 61, 50, 51}));
}

TEST(RawValues, forgettingLeavesTheOthers) {
    std::vector<float> samples(100000);
    std::iota(samples.begin(), samples.end(), 0.0f);
    RawValues values = valuesOf(samples);
    values.forget(10001, 70007);
    for (size_t n = 0; n < samples.size(); ++n) {
        const bool is_forgotten = n >= 10001 && n < 70007;
        ASSERT_TRUE(is_forgotten || values[n] == samples[n]) << n;
    }
}

}  // namespace
}  // namespace bonemill
