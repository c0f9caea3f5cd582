#include "common/rt/stop_signals.h"

#include <gtest/gtest.h>

#include <thread>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int64_t kSoonNs = 10 * kNsPerMillisecond;
constexpr int64_t kPatienceNs = 10 * kNsPerSecond;

// Each test is a process of its own under CTest; in one process the mask is the same from the first on.
class StopSignalsTest : public testing::TestWithParam<int> {};

TEST_P(StopSignalsTest, AreTakenByTheThreadThatAwaitsThemAndEndNothing) {
    const StopSignals signals;
    EXPECT_EQ(signals.await(kSoonNs), 0);
    std::thread([] { kill(getpid(), GetParam()); }).join();
    EXPECT_EQ(signals.await(kPatienceNs), GetParam());
    EXPECT_EQ(signals.await(kSoonNs), 0);
}

INSTANTIATE_TEST_SUITE_P(Each, StopSignalsTest, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(StopSignals, LeaveAnIgnoredHangupIgnored) {
    const auto before = signal(SIGHUP, SIG_IGN);
    const StopSignals signals;
    kill(getpid(), SIGHUP);
    EXPECT_EQ(signals.await(kSoonNs), 0);
    signal(SIGHUP, before);
}

}  // namespace
}  // namespace bonemill
