#include "common/rt/clock.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

// Many a decimal lies just below itself in binary, so that cutting it off loses a nanosecond.
TEST(Clock, MillisecondsAreRoundedToNanoseconds) {
    EXPECT_EQ(nsOfMilliseconds(20), 20'000'000);
    EXPECT_EQ(int64_t(2.01 * 1e6), 2'009'999);
    EXPECT_EQ(nsOfMilliseconds(2.01), 2'010'000);
}

}  // namespace
}  // namespace bonemill
