// The outermost function of a program, and what it asks for at its start, before its threads.
#pragma once

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <system_error>

#include "common/base/user_error.h"
#include "common/process/standard_output.h"

namespace bonemill {

// A program that another one of ours has started for itself, and that is of no use without it, ends with it:
// also when that one is killed and has no chance to say so. From now on this process gets SIGTERM when the
// thread ends that has started it, in the process `parent`; at once if that process has gone already, or has
// never been its parent.
inline void endWithParent(pid_t parent) noexcept {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    // Whoever died before this was set has left us to another parent.
    if (getppid() != parent) raise(SIGTERM);
}

// What the shell lets a program have (ulimit) is asked before a library that would crash without it. This
// takes all the files that this user may open at once. Throws UserError where these are too few for the
// network, the sound and a scan together.
inline void requireFileHandles() {
    constexpr rlim_t kMin = 64;
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kMin) return;
    limit.rlim_cur = std::min(limit.rlim_max, 16 * kMin);
    if (limit.rlim_cur >= kMin && setrlimit(RLIMIT_NOFILE, &limit) == 0) return;
    throw UserError("may open only " + std::to_string(limit.rlim_max) + " files at once, and needs " +
                    std::to_string(kMin) + "; type: ulimit -n 1024");
}

// Throws UserError where so much more memory cannot be asked for. `what` needs it: "the network".
inline void requireMemory(size_t bytes, const std::string& what) {
    void* const place =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED)
        throw UserError("there is not enough memory for " + what + ": " + std::to_string(bytes >> 20) +
                        " MiB more are needed; close other programs, or type: ulimit -v unlimited");
    munmap(place, bytes);
}

// `body` returns the exit code; what it throws, and what it could not print (standard_output.h), becomes a
// message and an exit code.
template <class Body>
int runProgram(Body&& body) {
    try {
        outliveReaders();
        requireFileHandles();
        const int exit_code = body();
        requirePrinted();
        return exit_code;
    } catch (const UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return kUserErrorExitCode;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: there is not enough memory; close other programs, or type: ulimit -v unlimited"
                  << std::endl;
        return 1;
    } catch (const std::system_error& error) {
        const bool is_of_thread = error.code() == std::errc::resource_unavailable_try_again;
        std::cerr << "error: "
                  << (is_of_thread ? "this PC grants no more threads or memory; see ulimit -u and ulimit -v"
                                   : error.what())
                  << std::endl;
        return 1;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return 1;
    }
}

}  // namespace bonemill
