// Threads that work beside a replay leave the processors to the one that is shown.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace bonemill {

// Of the calling thread, for its whole life.
inline void takeLowPriority() noexcept {
    constexpr int kNice = 10;
    setpriority(PRIO_PROCESS, id_t(gettid()), kNice);
}

}  // namespace bonemill
