// Keeps a library from allocating whatever a damaged length field says.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace bonemill {

// While it lives, the process may map at most `extra_bytes` more than it does now; beyond that, allocation
// fails with std::bad_alloc. It has no effect under sanitizers, which map terabytes themselves, and none
// while another one lives: that of several files (memoryForAll) counts for each of them. It is for start-up
// only; one that has an effect lives longer than all threads that begin after it.
class MemoryCap {
  public:
    explicit MemoryCap(uint64_t extra_bytes);
    ~MemoryCap();
    MemoryCap(const MemoryCap&) = delete;
    MemoryCap& operator=(const MemoryCap&) = delete;

  private:
    rlimit before_{};
    bool is_outermost_ = false, is_set_ = false;
};

// What reading a folder by several threads (work_ahead.h) may take: so much for one file, and for what comes
// of all.
uint64_t memoryForAll(uint64_t bytes_of_one, uint64_t bytes_taken);

// Does the same for all that this process will do, and cannot be taken back.
void capMemoryForGood(uint64_t extra_bytes) noexcept;

}  // namespace bonemill
