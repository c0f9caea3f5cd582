// Watches how much memory a process and all that it started take together, from beside.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

namespace bonemill::bench {

// It looks every 5 ms: what is there for less may be missed. Resident memory, where what several of the
// processes have in common (libraries) counts once in each.
class MemoryWatch {
  public:
    explicit MemoryWatch(int pid);
    size_t peakBytes() const { return peak_; }

  private:
    std::atomic<size_t> peak_ = 0;
    std::jthread thread_;
};

}  // namespace bonemill::bench
