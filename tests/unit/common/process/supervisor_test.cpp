// Work that hangs or dies is started again; work that is asked to end does.
#include "common/process/supervisor.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

namespace bonemill {
namespace {

using std::chrono::milliseconds;
using Work = std::function<int(const Heartbeat&, bool)>;

constexpr SupervisorTimes kShort{
    .round = milliseconds(10), .to_end = milliseconds(150), .to_rest = milliseconds(5)};

int superviseHere(
    const Work& work, const std::function<bool()>& should_stop = [] { return false; }) {
    const pid_t self = getpid();
    const int code = supervise("the test's work", should_stop, work, kShort);
    if (getpid() != self) _exit(code);  // the child goes no further in the tests
    return code;
}

[[noreturn]] void spin() {
    for (;;) asm volatile("");
}

TEST(Supervisor, WorkThatHangsOrDiesIsStartedAgain) {
    const std::pair<const char*, void (*)()> ends[] = {
        {"it spins", [] { spin(); }},
        {"it spins and takes no SIGTERM", [] { signal(SIGTERM, SIG_IGN), spin(); }},
        {"it is stopped", [] { raise(SIGSTOP), spin(); }},
        {"it crashes", [] { raise(SIGKILL); }},
        {"it gives up", [] { _exit(3); }}};
    for (const auto& [what, end] : ends)
        EXPECT_EQ(superviseHere([&end = end](const Heartbeat& heart, bool is_first) {
                      heart.beat();
                      std::this_thread::sleep_for(milliseconds(30));
                      if (is_first) end();
                      return 0;
                  }),
                  0)
            << what;
}

TEST(Supervisor, WorkThatComesRoundGoesOn) {
    int ends[2];  // a byte for each start
    ASSERT_EQ(pipe(ends), 0);
    EXPECT_EQ(superviseHere([&](const Heartbeat& heart, bool) {
                  EXPECT_EQ(write(ends[1], "", 1), 1);
                  for (int n = 0; n < 100; ++n) {
                      heart.beat();
                      std::this_thread::sleep_for(milliseconds(5));
                  }
                  return 0;
              }),
              0);
    char starts[16];
    EXPECT_EQ(read(ends[0], starts, sizeof starts), 1);
}

TEST(Supervisor, WhatCannotStartIsNotTriedAgain) {
    EXPECT_EQ(superviseHere([](const Heartbeat&, bool) { return 2; }), 2);
}

TEST(Supervisor, WhoeverStopsItWaitsForNothingThatSpins) {
    const auto start = std::chrono::steady_clock::now();
    const auto should_stop = [&] { return std::chrono::steady_clock::now() - start > milliseconds(50); };
    const auto work = [](const Heartbeat& heart, bool) -> int {
        signal(SIGTERM, SIG_IGN);
        heart.beat();
        spin();
    };
    EXPECT_EQ(superviseHere(work, should_stop), 128 + SIGKILL);
    sigset_t term, before;
    sigemptyset(&term), sigaddset(&term, SIGTERM);
    sigprocmask(SIG_BLOCK, &term, &before);  // for the child, from its first moment on
    const auto ends_in_order = [&term](const Heartbeat& heart, bool) {
        heart.beat();
        int number = 0;
        sigwait(&term, &number);
        return number == SIGTERM ? 0 : 1;
    };
    EXPECT_EQ(superviseHere(ends_in_order, should_stop), 0) << "who ends in order is let";
    sigprocmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace
}  // namespace bonemill
