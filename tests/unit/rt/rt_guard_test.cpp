#include "common/rt/rt_guard.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <mutex>

namespace bonemill {
namespace {

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
    void* const memory = std::malloc(10);
    EXPECT_DEATH(
        {
            const RtScope outer;
            { const RtScope inner; }
            std::free(memory);
        },
        "rt-guard: heap call inside a real-time scope: free");
    std::free(memory);
}

TEST(RtGuardDeathTest, abortsOnALockInsideAScope) {
    std::mutex mutex;
    EXPECT_DEATH(lockInScope(mutex), "rt-guard: lock inside a real-time scope: pthread_mutex_lock");
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
