#include "haptic_server/scans/confined/memory_cap.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <optional>

#include "common/process/work_ahead.h"

namespace bonemill {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

std::atomic<bool> is_capped = false;

// Returns the limits with `extra_bytes` more than is mapped now; nothing when there is no capping.
std::optional<rlimit> cappedLimit(uint64_t extra_bytes, rlimit& now) {
    uint64_t pages = 0;
    if (kIsSanitized || !(std::ifstream("/proc/self/statm") >> pages) || getrlimit(RLIMIT_AS, &now) != 0)
        return std::nullopt;
    rlimit capped = now;
    capped.rlim_cur = std::min<rlim_t>(now.rlim_cur, pages * uint64_t(sysconf(_SC_PAGESIZE)) + extra_bytes);
    return capped;
}

}  // namespace

MemoryCap::MemoryCap(uint64_t extra_bytes) : is_outermost_(!is_capped.exchange(true)) {
    if (!is_outermost_) return;
    const auto capped = cappedLimit(extra_bytes, before_);
    is_set_ = capped && setrlimit(RLIMIT_AS, &*capped) == 0;
}

MemoryCap::~MemoryCap() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
    if (is_outermost_) is_capped = false;
}

uint64_t memoryForAll(uint64_t bytes_of_one, uint64_t bytes_taken) {
    constexpr uint64_t kThread = uint64_t(256) << 20;  // its stack and its heap, most of it never used
    return mostAtATime() * (bytes_of_one + kThread) + bytes_taken;
}

void capMemoryForGood(uint64_t extra_bytes) noexcept {
    rlimit now{};
    auto capped = cappedLimit(extra_bytes, now);
    if (!capped) return;
    capped->rlim_max = capped->rlim_cur;
    setrlimit(RLIMIT_AS, &*capped);
}

}  // namespace bonemill
