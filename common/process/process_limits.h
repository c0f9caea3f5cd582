// What the shell lets a program have (ulimit), asked before a library that would crash without it.
//
// It is for start-up only, since it makes system calls.
#pragma once

#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {

// Takes all the files that this user may open at once. Throws UserError where these are too few for the
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

}  // namespace bonemill
