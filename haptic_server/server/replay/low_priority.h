// Threads that work beside a replay leave the processors to the one that is shown.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace bonemill {

// As nice values: what nobody waits for, and what somebody does, who looks on. Beside two busy threads on two
// processors the latter has some quarter of one, the former a tenth.
inline constexpr int kNiceInBackground = 10, kNiceBeside = 5;

// Of the calling thread, for its whole life.
inline void takeLowPriority(int nice) noexcept {
    setpriority(PRIO_PROCESS, id_t(gettid()), nice);
}

}  // namespace bonemill
