// A test or a benchmark that is killed leaves nothing behind that it has started.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/fork_child.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

// Starts a program in another process, which is killed then. Returns the program's number; this process is
// its parent from then on.
pid_t startedByOneThatWasKilled(const std::vector<std::string>& program) {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    int ends[2];
    if (pipe(ends) != 0) return -1;
    const pid_t starter = test::forkChild();
    if (starter == 0) {
        const test::Process started(program);
        const pid_t number = started.pid();
        if (write(ends[1], &number, sizeof number) != sizeof number) _exit(1);
        for (;;) pause();
    }
    pid_t number = -1;
    EXPECT_EQ(read(ends[0], &number, sizeof number), ssize_t(sizeof number));
    kill(starter, SIGKILL);
    waitpid(starter, nullptr, 0);
    close(ends[0]);
    close(ends[1]);
    return number;
}

TEST(KilledParent, WhatItHasStartedEndsWithIt) {
    for (const std::vector<std::string>& program :
         {std::vector<std::string>{"/bin/sleep", "1000"},
          {"device_daemon", "--device", "simulated", "--session", std::to_string(getpid())}}) {
        const pid_t number = startedByOneThatWasKilled(program);
        ASSERT_GT(number, 0);
        const bool has_ended =
            test::waitFor([&] { return waitpid(number, nullptr, WNOHANG) != 0; }, std::chrono::seconds(10));
        EXPECT_TRUE(has_ended) << program[0];
        if (has_ended) continue;
        kill(number, SIGKILL);
        waitpid(number, nullptr, 0);
    }
}

}  // namespace
}  // namespace bonemill
