#include <gtest/gtest.h>

#include "render_client/link/subscribe/heard_peers.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr SilenceMonitor::Clock::time_point kBegin{1000s};

// Looks every 10 ms until then; returns when it was due.
std::vector<SilenceMonitor::Clock::duration> dueTimes(SilenceMonitor& watch,
                                                      SilenceMonitor::Clock::duration from,
                                                      SilenceMonitor::Clock::duration until) {
    std::vector<SilenceMonitor::Clock::duration> due;
    for (auto time = from; time < until; time += 10ms) {
        watch.pass(kBegin + time);
        if (watch.isDue(kBegin + time)) due.push_back(time);
    }
    return due;
}

TEST(SilenceMonitor, IsDueEverMoreSeldomWhileNothingIsHeard) {
    SilenceMonitor watch(6s, kBegin);
    const std::vector<SilenceMonitor::Clock::duration> expected{6s, 18s, 42s, 72s, 102s};
    EXPECT_EQ(dueTimes(watch, 0s, 110s), expected);
    watch.hear(kBegin + 110s);
    EXPECT_EQ(dueTimes(watch, 110s, 120s), std::vector<SilenceMonitor::Clock::duration>{116s});
}

TEST(SilenceMonitor, SilenceInItsSleepDoesNotCount) {
    SilenceMonitor watch(6s, kBegin);
    EXPECT_TRUE(dueTimes(watch, 0s, 5s).empty());
    EXPECT_GT(watch.pass(kBegin + 100s), 94s);
    EXPECT_FALSE(watch.isDue(kBegin + 100s));
    EXPECT_EQ(watch.pass(kBegin + 100s + 10ms), 0s);
    EXPECT_EQ(dueTimes(watch, 100s, 110s).size(), 1u);
}

}  // namespace
}  // namespace bonemill
