#include <gtest/gtest.h>

#include "common/log/log.h"

namespace bonemill {
namespace {

constexpr int64_t kLogSecondNs = 1'000'000'000;

TEST(LogLimit, OfAFloodTheFirstAreSaidAndThenOneNowAndThenWithItsCount) {
    LogLimit limit(10, 60 * kLogSecondNs);
    for (int n = 0; n < 10; ++n) EXPECT_EQ(limit.ask(n), 0) << n;
    for (int n = 0; n < 5000; ++n) EXPECT_EQ(limit.ask(kLogSecondNs), -1);
    EXPECT_EQ(limit.ask(62 * kLogSecondNs), 5000);
    EXPECT_EQ(limit.ask(63 * kLogSecondNs), -1);
    EXPECT_EQ(limit.ask(200 * kLogSecondNs), 1);
}

TEST(LogLimit, RareMessagesAreAllSaid) {
    LogLimit limit(10, 60 * kLogSecondNs);
    for (int n = 0; n < 100; ++n) EXPECT_EQ(limit.ask(61 * kLogSecondNs * n), 0) << n;
}

}  // namespace
}  // namespace bonemill
