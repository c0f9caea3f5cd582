#include "common/rt/realtime.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <thread>

namespace bonemill {
namespace {

bool mentions(const std::vector<std::string>& sentences, const std::string& word) {
    for (const std::string& sentence : sentences) {
        if (sentence.find(word) != std::string::npos) return true;
    }
    return false;
}

// Each test uses a thread of its own: the main thread of the test program stays as it is.
template <class Body>
void inThread(Body body) {
    std::thread(body).join();
}

TEST(Realtime, saysSchedFifoIsMissingExactlyWhenItIs) {
    inThread([] {
        const RealtimeReport report = makeThreadRealtime({.priority = 10});
        int policy = 0;
        sched_param parameters{};
        ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &parameters), 0);
        EXPECT_EQ(mentions(report.missing, "SCHED_FIFO"), policy != SCHED_FIFO);
        if (policy == SCHED_FIFO) {
            EXPECT_EQ(parameters.sched_priority, 10);
        }
    });
}

TEST(Realtime, refusedPriorityIsReported) {
    inThread([] { EXPECT_TRUE(mentions(makeThreadRealtime({.priority = 1000}).missing, "SCHED_FIFO")); });
}

TEST(Realtime, pinsToTheCoreAskedFor) {
    cpu_set_t allowed;
    ASSERT_EQ(sched_getaffinity(0, sizeof(allowed), &allowed), 0);
    int core = 0;
    while (!CPU_ISSET(size_t(core), &allowed)) ++core;
    inThread([core] {
        const RealtimeReport report = makeThreadRealtime({.priority = 10, .core = core});
        EXPECT_FALSE(mentions(report.missing, "pinned"));
        EXPECT_EQ(sched_getcpu(), core);
    });
}

TEST(Realtime, saysThatACoreDoesNotExist) {
    inThread([] { EXPECT_TRUE(mentions(makeThreadRealtime({.core = 100'000}).missing, "no core 100000")); });
}

}  // namespace
}  // namespace bonemill
