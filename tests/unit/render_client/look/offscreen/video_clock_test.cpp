#include <gtest/gtest.h>

#include "render_client/look/offscreen/video_file.h"

namespace bonemill {
namespace {

TEST(VideoClock, ASecondOfTheSessionIsASecondOfTheVideoHoweverRarelyItIsDrawn) {
    for (const double drawn_every_s : {0.004, 0.04, 0.17, 0.9}) {
        VideoClock clock(25, false);
        uint64_t frames = 0;
        double now = 1000;
        for (; now < 1010; now += drawn_every_s) frames += clock.due(now);
        EXPECT_NEAR(double(frames), (now - drawn_every_s - 1000) * 25 + 1, 1) << drawn_every_s;
    }
}

TEST(VideoClock, NoFrameIsDueTwice) {
    VideoClock clock(30, true);
    EXPECT_EQ(clock.due(5), 1u);
    EXPECT_EQ(clock.due(5), 0u);
    EXPECT_EQ(clock.due(5 + 0.9 / 30), 0u);
    EXPECT_EQ(clock.due(5 + 1.0 / 30), 1u);
    EXPECT_EQ(clock.due(5 + 3.0 / 30), 2u);
}

TEST(VideoClock, AReplayMayBeSoughtInBothWays) {
    VideoClock clock(10, true);
    EXPECT_EQ(clock.due(50), 1u);
    EXPECT_EQ(clock.due(50.1), 1u);
    EXPECT_EQ(clock.due(20), 0u) << "back";
    EXPECT_EQ(clock.due(20.1), 1u);
    EXPECT_EQ(clock.due(400), 0u) << "ahead";
    EXPECT_EQ(clock.due(400.2), 2u);
}

TEST(VideoClock, APictureThatTakesLongIsNoLeap) {
    VideoClock clock(10, true);
    EXPECT_EQ(clock.due(0), 1u);
    EXPECT_EQ(clock.due(2, 2), 20u);
}

TEST(VideoClock, ALiveSessionThatIsDrawnLateLeapsNowhere) {
    VideoClock clock(10, false);
    EXPECT_EQ(clock.due(0), 1u);
    EXPECT_EQ(clock.due(3), 30u);
    EXPECT_EQ(clock.due(2), 0u) << "a clock that was set back";
    EXPECT_EQ(clock.due(2.1), 1u);
}

}  // namespace
}  // namespace bonemill
