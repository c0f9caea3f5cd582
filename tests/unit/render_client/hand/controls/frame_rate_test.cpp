#include <gtest/gtest.h>

#include "render_client/hand/controls/announcing.h"

namespace bonemill {
namespace {

using std::chrono::milliseconds;

TEST(FrameRate, NothingBeforeTheSecondPicture) {
    FrameRate rate;
    EXPECT_EQ(rate.perSecond(), 0);
    rate.countPicture({});
    EXPECT_EQ(rate.perSecond(), 0);
}

TEST(FrameRate, IsThatOfTheLastSecond) {
    FrameRate rate;
    FrameRate::Clock::time_point now;
    for (int i = 0; i < 100; ++i) rate.countPicture(now += milliseconds(100));
    EXPECT_NEAR(rate.perSecond(), 10, 1e-9);
    for (int i = 0; i < 60; ++i) rate.countPicture(now += milliseconds(20));
    EXPECT_NEAR(rate.perSecond(), 50, 1e-9);
}

TEST(FrameRate, SlowerThanOnePerSecondToo) {
    FrameRate rate;
    FrameRate::Clock::time_point now;
    for (int i = 0; i < 5; ++i) rate.countPicture(now += milliseconds(2000));
    EXPECT_NEAR(rate.perSecond(), 0.5, 1e-9);
}

}  // namespace
}  // namespace bonemill
