// Marks the code that may neither allocate nor lock: the inside of a tick.
//
// An executable that links bonemill::rt_guard aborts with a message when this thread calls heap or lock
// functions inside an RtScope. Tests do so, and the programs' guarded twins; in others a scope only counts.
#pragma once

#include <atomic>

namespace bonemill {

namespace rt_guard {
inline constinit thread_local int scope_depth = 0;
}

class [[nodiscard]] RtScope {
  public:
    // The fences keep the depth in memory: compilers know that malloc and free look at no variable of ours.
    RtScope() noexcept {
        ++rt_guard::scope_depth;
        std::atomic_signal_fence(std::memory_order_seq_cst);
    }
    ~RtScope() {
        std::atomic_signal_fence(std::memory_order_seq_cst);
        --rt_guard::scope_depth;
    }
    RtScope(const RtScope&) = delete;
    RtScope& operator=(const RtScope&) = delete;
};

}  // namespace bonemill
