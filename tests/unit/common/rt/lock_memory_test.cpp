// This test is not in sanitizer builds: they turn mlockall into nothing.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "common/rt/realtime.h"

namespace bonemill {
namespace {

long lockedKib() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmLck:")) return std::stol(line.substr(6));
    }
    return -1;
}

TEST(LockMemory, saysMemoryIsNotLockedExactlyWhenItIsNot) {
    // It runs in a child, so that the lock and the heap's new habits stay out of the other tests.
    const pid_t child = fork();
    if (child == 0) {
        const bool is_reported = !lockMemory().missing.empty();
        _exit(lockedKib() >= 0 && is_reported == (lockedKib() == 0) ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace bonemill
