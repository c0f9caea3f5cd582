#include "common/rt/rt_guard.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <cstdlib>
#include <mutex>

namespace bonemill {
namespace {

// The compiler may drop an allocation whose result nobody sees.
void* volatile seen_by_nobody_knows_whom;

void allocateInScope() {
    const RtScope scope;
    seen_by_nobody_knows_whom = std::malloc(10);
}

void lockInScope(std::mutex& mutex) {
    const RtScope scope;
    const std::lock_guard guard(mutex);
}

TEST(RtGuardDeathTest, abortsOnAnAllocationInsideAScope) {
    EXPECT_DEATH(allocateInScope(), "rt-guard: heap call inside a real-time scope: malloc");
}

TEST(RtGuardDeathTest, abortsOnAFreeInsideANestedScope) {
    seen_by_nobody_knows_whom = std::malloc(10);
    EXPECT_DEATH(
        {
            const RtScope outer;
            { const RtScope inner; }
            std::free(seen_by_nobody_knows_whom);
        },
        "rt-guard: heap call inside a real-time scope: free");
    std::free(seen_by_nobody_knows_whom);
}

TEST(RtGuardDeathTest, abortsOnALockInsideAScope) {
    std::mutex mutex;
    EXPECT_DEATH(lockInScope(mutex), "rt-guard: lock inside a real-time scope: pthread_mutex_lock");
}

TEST(RtGuardDeathTest, abortsOnASignalInsideAScope) {
    std::condition_variable condition;
    EXPECT_DEATH(
        {
            const RtScope scope;
            condition.notify_one();
        },
        "rt-guard: lock inside a real-time scope: pthread_cond_signal");
}

TEST(RtGuard, letsTheRestOfTheProgramAlone) {
    { const RtScope scope; }
    seen_by_nobody_knows_whom = std::malloc(10);
    std::free(seen_by_nobody_knows_whom);
    std::mutex mutex;
    EXPECT_TRUE(mutex.try_lock());
    mutex.unlock();
}

}  // namespace
}  // namespace bonemill
