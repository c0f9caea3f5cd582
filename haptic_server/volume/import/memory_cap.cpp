#include "haptic_server/volume/import/memory_cap.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace bonemill {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

}  // namespace

MemoryCap::MemoryCap(uint64_t extra_bytes) {
    uint64_t pages = 0;
    if (kIsSanitized || !(std::ifstream("/proc/self/statm") >> pages) || getrlimit(RLIMIT_AS, &before_) != 0)
        return;
    rlimit capped = before_;
    capped.rlim_cur =
        std::min<rlim_t>(before_.rlim_cur, pages * uint64_t(sysconf(_SC_PAGESIZE)) + extra_bytes);
    is_set_ = setrlimit(RLIMIT_AS, &capped) == 0;
}

MemoryCap::~MemoryCap() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
}

}  // namespace bonemill
