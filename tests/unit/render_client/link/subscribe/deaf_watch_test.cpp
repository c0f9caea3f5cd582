#include "render_client/link/subscribe/deaf_watch.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr DeafWatch::Clock::time_point kBegin{1000s};

// Looks every 10 ms until then; returns when it was due.
std::vector<DeafWatch::Clock::duration> dueTimes(DeafWatch& watch, DeafWatch::Clock::duration from,
                                                 DeafWatch::Clock::duration until) {
    std::vector<DeafWatch::Clock::duration> due;
    for (auto time = from; time < until; time += 10ms) {
        watch.pass(kBegin + time);
        if (watch.isDue(kBegin + time)) due.push_back(time);
    }
    return due;
}

TEST(DeafWatch, IsDueEverMoreSeldomWhileNothingIsHeard) {
    DeafWatch watch(6s, kBegin);
    const std::vector<DeafWatch::Clock::duration> expected{6s, 18s, 42s, 72s, 102s};
    EXPECT_EQ(dueTimes(watch, 0s, 110s), expected);
    watch.hear(kBegin + 110s);
    EXPECT_EQ(dueTimes(watch, 110s, 120s), std::vector<DeafWatch::Clock::duration>{116s});
}

TEST(DeafWatch, SilenceInItsSleepDoesNotCount) {
    DeafWatch watch(6s, kBegin);
    EXPECT_TRUE(dueTimes(watch, 0s, 5s).empty());
    EXPECT_GT(watch.pass(kBegin + 100s), 94s);
    EXPECT_FALSE(watch.isDue(kBegin + 100s));
    EXPECT_EQ(watch.pass(kBegin + 100s + 10ms), 0s);
    EXPECT_EQ(dueTimes(watch, 100s, 110s).size(), 1u);
}

}  // namespace
}  // namespace bonemill
