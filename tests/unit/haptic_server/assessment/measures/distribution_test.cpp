#include "haptic_server/assessment/measures/distribution.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace bonemill {
namespace {

TEST(Distribution, QuantilesAreRightToHalfItsResolution) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> values(0, 2);
    Distribution distribution;
    std::vector<double> all;
    for (int n = 0; n < 20'001; ++n) {
        all.push_back(values(random));
        distribution.add(all.back());
    }
    std::ranges::sort(all);
    for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
        const double exact = all[size_t(share * 20'000)];
        EXPECT_NEAR(distribution.quantile(share), exact,
                    exact * 1.01 * Distribution::kResolution / 2 + 1e-3 * exact);
    }
    EXPECT_EQ(distribution.max(), all.back());
}

TEST(Distribution, WeightsCountAsOftenAsTheySay) {
    Distribution distribution;
    distribution.add(1, 3);
    distribution.add(10, 1);
    EXPECT_NEAR(distribution.median(), 1, 0.006);
    EXPECT_NEAR(distribution.quantile(0.9), 10, 0.06);
    EXPECT_DOUBLE_EQ(distribution.mean(), 13.0 / 4);
    EXPECT_DOUBLE_EQ(distribution.weight(), 4);
}

TEST(Distribution, HoldsWhateverComes) {
    Distribution distribution;
    EXPECT_TRUE(std::isnan(distribution.median()));
    EXPECT_TRUE(std::isnan(distribution.mean()));
    EXPECT_TRUE(std::isnan(distribution.max()));
    distribution.add(std::nan(""));
    distribution.add(INFINITY);
    distribution.add(1, 0);
    EXPECT_EQ(distribution.weight(), 0);
    distribution.add(0);
    EXPECT_EQ(distribution.median(), 0);
    distribution.add(1e12, 100);
    EXPECT_NEAR(distribution.median(), Distribution::kLargest, 0.02 * Distribution::kLargest);
}

}  // namespace
}  // namespace bonemill
