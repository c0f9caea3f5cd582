#include <gtest/gtest.h>

#include "render_client/hand/controls/announcing.h"

namespace bonemill {
namespace {

using std::chrono::milliseconds;

int countDue(AnnounceClock& clock, AnnounceClock::Clock::time_point& now, bool is_pointing) {
    int count = 0;
    for (int ms = 0; ms < 3000; ++ms) count += clock.isDue(now += milliseconds(1), is_pointing);
    return count;
}

TEST(AnnounceClock, OncePerSecondAndThirtyTimesWhilePointing) {
    AnnounceClock clock;
    AnnounceClock::Clock::time_point now;
    EXPECT_EQ(countDue(clock, now, false), 3);
    EXPECT_NEAR(countDue(clock, now, true), 90, 3);
    EXPECT_EQ(countDue(clock, now, false), 3);
}

TEST(AnnounceClock, AtOnceWhenPointingStartsOrStops) {
    AnnounceClock clock;
    const AnnounceClock::Clock::time_point now;
    EXPECT_TRUE(clock.isDue(now, false));
    EXPECT_FALSE(clock.isDue(now + milliseconds(1), false));
    EXPECT_TRUE(clock.isDue(now + milliseconds(2), true));
    EXPECT_TRUE(clock.isDue(now + milliseconds(3), false));
}

}  // namespace
}  // namespace bonemill
