// Counts what this thread does to the heap and to locks while an RtProbe lives. It is for tests that prove
// that a tick does neither; it is not in sanitizer builds, which replace the same functions (there the target
// bonemill::rt_probe does not exist, so a test that needs it is listed under `if(NOT BONEMILL_SANITIZE)`).
#pragma once

#include <cstdint>

namespace bonemill {

// There is one at a time per thread. The counters stay readable after stop(), where a test may
// allocate again.
class RtProbe {
  public:
    RtProbe() noexcept;
    ~RtProbe() { stop(); }
    RtProbe(const RtProbe&) = delete;
    RtProbe& operator=(const RtProbe&) = delete;

    void stop() noexcept;

    uint64_t heapCalls() const noexcept { return heap_calls_; }
    uint64_t lockCalls() const noexcept { return lock_calls_; }
    // Names the first function counted, for the failure message, or "none".
    const char* firstCall() const noexcept { return first_call_; }

    // The interposed functions call them.
    void countHeapCall(const char* function) noexcept;
    void countLockCall(const char* function) noexcept;

  private:
    void noteFirst(const char* function) noexcept;

    uint64_t heap_calls_ = 0;
    uint64_t lock_calls_ = 0;
    const char* first_call_ = "none";
};

}  // namespace bonemill
