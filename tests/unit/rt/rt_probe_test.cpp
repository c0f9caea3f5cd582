#include "tests/support/rt_guard/rt_probe.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/rt/latency_histogram.h"
#include "common/rt/seqlock.h"
#include "common/rt/spsc_ring.h"

namespace bonemill {
namespace {

// The compiler may drop an allocation whose result nobody sees.
void* volatile seen_by_nobody_knows_whom;

TEST(RtProbe, countsEveryWayToTheHeap) {
    RtProbe probe;
    seen_by_nobody_knows_whom = std::malloc(10);
    std::free(seen_by_nobody_knows_whom);
    EXPECT_EQ(probe.heapCalls(), 2u);
    const std::vector<int> numbers(100);
    seen_by_nobody_knows_whom = const_cast<int*>(numbers.data());
    EXPECT_EQ(probe.heapCalls(), 3u);
    const Eigen::VectorXd vector = Eigen::VectorXd::Zero(50);
    seen_by_nobody_knows_whom = const_cast<double*>(vector.data());
    EXPECT_EQ(probe.heapCalls(), 4u);
    struct alignas(64) Wide {
        char bytes[64];
    };
    const auto wide = std::make_unique<Wide>();
    seen_by_nobody_knows_whom = wide.get();
    EXPECT_EQ(probe.heapCalls(), 5u);
    EXPECT_EQ(probe.lockCalls(), 0u);
    EXPECT_STREQ(probe.firstCall(), "malloc");
}

TEST(RtProbe, countsLocks) {
    std::mutex mutex;
    std::shared_mutex shared_mutex;
    RtProbe probe;
    { const std::lock_guard guard(mutex); }
    { const std::shared_lock guard(shared_mutex); }
    { const std::unique_lock guard(shared_mutex); }
    probe.stop();
    EXPECT_EQ(probe.lockCalls(), 3u);
    EXPECT_EQ(probe.heapCalls(), 0u);
    EXPECT_STREQ(probe.firstCall(), "pthread_mutex_lock");
}

TEST(RtProbe, countsThisThreadAndThisScopeOnly) {
    { seen_by_nobody_knows_whom = std::make_unique<int>(1).get(); }
    std::thread other;
    {
        RtProbe probe;
        probe.stop();
        other = std::thread([] { seen_by_nobody_knows_whom = std::make_unique<int>(1).get(); });
        other.join();
        EXPECT_EQ(probe.heapCalls(), 0u);
        EXPECT_STREQ(probe.firstCall(), "none");
    }
}

TEST(RtProbe, findsNothingInTheToolsOfTheTick) {
    SpscRing<int> ring(2);
    Seqlock<int> lock;
    LatencyHistogram histogram;
    int item = 0;
    RtProbe probe;
    for (int i = 0; i < 5; ++i) ring.tryPush(i);
    ring.tryPop(item);
    lock.write(item);
    lock.tryRead(item);
    histogram.record(1234);
    probe.stop();
    EXPECT_EQ(probe.heapCalls() + probe.lockCalls(), 0u) << probe.firstCall();
}

}  // namespace
}  // namespace bonemill
