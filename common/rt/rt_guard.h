// Marks the code that may neither allocate nor lock: the inside of a tick.
//
// In the rt-guard build (BONEMILL_RT_GUARD) an executable that links bonemill::rt_guard_interpose aborts with
// a message when heap or lock functions are called by this thread inside an RtScope. In other builds RtScope
// is nothing.
#pragma once

#ifdef BONEMILL_RT_GUARD
#include <atomic>
#endif

namespace bonemill {

#ifdef BONEMILL_RT_GUARD

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

#else

class [[nodiscard]] RtScope {
  public:
    RtScope() noexcept {}  // user-provided: an unused RtScope variable is no warning
};

#endif

}  // namespace bonemill
