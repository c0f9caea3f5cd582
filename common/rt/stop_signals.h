// A program that must end in order takes the signals that ask for it in one thread, at a time of its own.
#pragma once

#include <signal.h>

#include <cstdint>

namespace bonemill {

class StopSignals {
  public:
    // Blocks SIGINT, SIGTERM and SIGHUP in the calling thread, for good, and in all threads and programs that
    // it starts from then on, so that await() gets them. A SIGHUP that is ignored (nohup) stays so. Make it
    // before the first thread.
    StopSignals() noexcept;

    // Waits for one of them. Returns its number, or 0 when none has come within `timeout_ns`. One thread may
    // call it; it is not RT-safe.
    int await(int64_t timeout_ns) const noexcept;

  private:
    sigset_t signals_;
};

}  // namespace bonemill
