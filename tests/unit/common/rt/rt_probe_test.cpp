#include "tests/support/rt_guard/rt_probe.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <pthread.h>
#include <semaphore.h>

#include <Eigen/Core>
#include <condition_variable>
#include <cstdlib>
#include <functional>
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
    seen_by_nobody_knows_whom = reallocarray(nullptr, 2, 5);
    EXPECT_EQ(probe.heapCalls(), 6u);
    seen_by_nobody_knows_whom = valloc(10);
    EXPECT_EQ(probe.heapCalls(), 7u);
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

// All of these are held, or were never set, and the instant is past: each call gives up at once.
TEST(RtProbe, countsLocksThatGiveUp) {
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_rwlock_t rwlock = PTHREAD_RWLOCK_INITIALIZER;
    pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
    pthread_spinlock_t spinlock;
    sem_t semaphore;
    ASSERT_EQ(pthread_spin_init(&spinlock, PTHREAD_PROCESS_PRIVATE), 0);
    ASSERT_EQ(sem_init(&semaphore, 0, 0), 0);
    pthread_mutex_lock(&mutex);
    pthread_rwlock_wrlock(&rwlock);
    pthread_spin_lock(&spinlock);
    const timespec past{1, 0};
    constexpr clockid_t kClock = CLOCK_MONOTONIC;
    const std::pair<const char*, std::function<int()>> calls[] = {
        {"pthread_mutex_trylock", [&] { return pthread_mutex_trylock(&mutex); }},
        {"pthread_mutex_timedlock", [&] { return pthread_mutex_timedlock(&mutex, &past); }},
        {"pthread_mutex_clocklock", [&] { return pthread_mutex_clocklock(&mutex, kClock, &past); }},
        {"pthread_rwlock_tryrdlock", [&] { return pthread_rwlock_tryrdlock(&rwlock); }},
        {"pthread_rwlock_trywrlock", [&] { return pthread_rwlock_trywrlock(&rwlock); }},
        {"pthread_rwlock_timedrdlock", [&] { return pthread_rwlock_timedrdlock(&rwlock, &past); }},
        {"pthread_rwlock_timedwrlock", [&] { return pthread_rwlock_timedwrlock(&rwlock, &past); }},
        {"pthread_rwlock_clockrdlock", [&] { return pthread_rwlock_clockrdlock(&rwlock, kClock, &past); }},
        {"pthread_rwlock_clockwrlock", [&] { return pthread_rwlock_clockwrlock(&rwlock, kClock, &past); }},
        {"pthread_spin_trylock", [&] { return pthread_spin_trylock(&spinlock); }},
        {"pthread_cond_timedwait", [&] { return pthread_cond_timedwait(&condition, &mutex, &past); }},
        {"pthread_cond_clockwait", [&] { return pthread_cond_clockwait(&condition, &mutex, kClock, &past); }},
        {"sem_trywait", [&] { return sem_trywait(&semaphore); }},
        {"sem_timedwait", [&] { return sem_timedwait(&semaphore, &past); }},
        {"sem_clockwait", [&] { return sem_clockwait(&semaphore, kClock, &past); }},
    };
    for (const auto& [name, call] : calls) {
        RtProbe probe;
        const int result = call();
        probe.stop();
        EXPECT_NE(result, 0) << name;
        EXPECT_EQ(probe.lockCalls(), 1u) << name;
        EXPECT_EQ(probe.heapCalls(), 0u) << name;
        EXPECT_STREQ(probe.firstCall(), name);
    }
    sem_destroy(&semaphore);
    pthread_spin_unlock(&spinlock);
    pthread_rwlock_unlock(&rwlock);
    pthread_mutex_unlock(&mutex);
}

// The C library has condition variables of two kinds; of two different ones a waiter would not come back.
TEST(RtProbe, countsConditionVariablesThatStillWakeTheirWaiter) {
    std::mutex mutex;
    std::condition_variable condition;
    bool is_awaited = false, is_set = false;
    std::string first_of_waiter;
    std::thread waiter([&] {
        std::unique_lock guard(mutex);
        is_awaited = true;
        RtProbe probe;
        while (!is_set) condition.wait(guard);
        probe.stop();
        first_of_waiter = probe.firstCall();
    });
    for (bool is_done = false; !is_done; std::this_thread::yield()) {
        const std::lock_guard guard(mutex);
        is_done = is_set = is_awaited;
    }
    RtProbe probe;
    condition.notify_one();
    EXPECT_STREQ(probe.firstCall(), "pthread_cond_signal");
    condition.notify_all();
    probe.stop();
    EXPECT_EQ(probe.lockCalls(), 2u);
    waiter.join();
    EXPECT_EQ(first_of_waiter, "pthread_cond_wait");
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
