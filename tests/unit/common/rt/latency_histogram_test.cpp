#include "common/rt/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace bonemill {
namespace {

TEST(LatencyHistogram, isZeroWithoutRecords) {
    const LatencyHistogram histogram;
    EXPECT_EQ(histogram.count(), 0u);
    EXPECT_EQ(histogram.percentileNs(50), 0);
    EXPECT_EQ(histogram.maxNs(), 0);
    EXPECT_EQ(histogram.meanNs(), 0.0);
}

TEST(LatencyHistogram, resolvesOnePercentFrom100NsTo10S) {
    for (double value = 100; value <= 1e10; value *= 1.0037) {
        const auto duration = int64_t(value);
        LatencyHistogram histogram;
        histogram.record(duration);
        histogram.record(LatencyHistogram::kLargestNs);  // keeps the maximum from hiding the bucket's end
        const int64_t found = histogram.percentileNs(50);
        ASSERT_GE(found, duration);
        ASSERT_LE(double(found - duration), 0.01 * double(duration)) << duration;
    }
}

TEST(LatencyHistogram, percentilesMatchSortedRecords) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> latency(std::log(30e3), 1.0);
    std::vector<int64_t> all(20'000);
    LatencyHistogram histogram;
    for (int64_t& duration : all) {
        duration = int64_t(latency(random));
        histogram.record(duration);
    }
    std::sort(all.begin(), all.end());
    double sum = 0;
    for (const int64_t duration : all) sum += double(duration);
    EXPECT_NEAR(histogram.meanNs(), sum / double(all.size()), 1e-6);
    EXPECT_EQ(histogram.maxNs(), all.back());
    EXPECT_EQ(histogram.percentileNs(100), all.back());
    for (const double percent : {0.1, 50.0, 99.0, 99.9}) {
        const double exact = double(all[size_t(std::ceil(percent / 100 * double(all.size()))) - 1]);
        EXPECT_NEAR(double(histogram.percentileNs(percent)), exact, 0.01 * exact) << percent;
    }
}

TEST(LatencyHistogram, mergeEqualsRecordingTogether) {
    LatencyHistogram one, two, both;
    for (int64_t i = 0; i < 1000; ++i) {
        (i % 3 ? one : two).record(i * i * 37);
        both.record(i * i * 37);
    }
    one.merge(two);
    EXPECT_EQ(one.count(), both.count());
    EXPECT_EQ(one.maxNs(), both.maxNs());
    EXPECT_EQ(one.meanNs(), both.meanNs());
    for (double percent = 0; percent <= 100; percent += 5) {
        EXPECT_EQ(one.percentileNs(percent), both.percentileNs(percent));
    }
}

TEST(LatencyHistogram, acceptsAnyInteger) {
    LatencyHistogram histogram;
    histogram.record(-5);
    histogram.record(INT64_MIN);
    EXPECT_EQ(histogram.percentileNs(99), 0);
    histogram.record(3 * LatencyHistogram::kLargestNs);
    EXPECT_EQ(histogram.maxNs(), 3 * LatencyHistogram::kLargestNs);
    EXPECT_EQ(histogram.percentileNs(100), 3 * LatencyHistogram::kLargestNs);
}

}  // namespace
}  // namespace bonemill
