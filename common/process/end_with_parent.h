// A program that another one of ours has started for itself, and that is of no use without it, ends with it:
// also when that one is killed and has no chance to say so.
//
// It is for the start of a program, before its threads.
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace bonemill {

// From now on this process gets SIGTERM when the thread ends that has started it, in the process `parent`; at
// once if that process has gone already, or has never been its parent.
inline void endWithParent(pid_t parent) noexcept {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    // Whoever died before this was set has left us to another parent.
    if (getppid() != parent) raise(SIGTERM);
}

}  // namespace bonemill
