// Tells how often a thread of this process had to wait for a page of memory. It reads /proc and
// is not RT-safe.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>

namespace bonemill {

struct PageFaults {
    uint64_t minor = 0;  // the page was in memory, and only had to be entered into the page table
    uint64_t major = 0;  // it came from a disk
};

// Counts since the thread's start; it returns nothing when there is no such thread. `thread` is
// what gettid() says.
std::optional<PageFaults> pageFaultsOf(pid_t thread);

}  // namespace bonemill
