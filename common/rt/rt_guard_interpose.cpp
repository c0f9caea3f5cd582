// Inside an RtScope a heap or lock call ends the program with a message (rt_guard.h).
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "common/rt/rt_guard.h"
#include "common/rt/rt_interpose.h"

namespace bonemill::rt_guard {
namespace {

// It calls write and abort only, because stdio would allocate and lock.
void refuse(const char* kind, const char* function) noexcept {
    if (scope_depth == 0) return;
    scope_depth = 0;
    const char* const parts[] = {"rt-guard: ", kind, " inside a real-time scope: ", function, "\n"};
    for (const char* part : parts) {
        if (write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
    }
    std::abort();
}

}  // namespace

void onHeapCall(const char* function) noexcept {
    refuse("heap call", function);
}
void onLockCall(const char* function) noexcept {
    refuse("lock", function);
}

}  // namespace bonemill::rt_guard
