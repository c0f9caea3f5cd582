// A process that a test or a benchmark starts never outlives it, whatever ends that one.
#pragma once

#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "common/process/run_program.h"

namespace bonemill::test {

// As fork(). The child, and the program that it becomes, gets SIGTERM when this process ends, also when that
// is killed. The kernel takes the end of the thread that has started a child for the end of its parent: call
// it from the main thread, or the test ends here.
inline pid_t forkChild() {
    const pid_t parent = getpid();
    if (syscall(SYS_gettid) != parent) {
        std::fputs("forkChild: is for the main thread, whose end is that of the process\n", stderr);
        std::abort();
    }
    const pid_t child = fork();
    if (child == 0) endWithParent(parent);
    return child;
}

}  // namespace bonemill::test
