// It is a thread that keeps deadlines, started the same way by every program that has one.
//
// It is for start-up only, since it makes system calls and allocates.
#pragma once

#include <sys/types.h>

#include <functional>
#include <thread>

#include "common/rt/realtime.h"

namespace bonemill {

struct RealtimeThreadConfig {
    RealtimeRequest request;
    bool is_strict = false;  // do not go on without what the machine does not grant
    std::string what = {};   // of messages: "the haptic loop"
};

class RealtimeThread {
  public:
    RealtimeThread() = default;

    // Locks the memory of the process, starts the thread, makes it real-time, and lets `work` begin when
    // all of that is granted or the caller does not insist on it. `tell` is called once with what the machine
    // says, in the calling thread. Throws UserError, before `work` has begun, when something is missing and
    // it is strict; then the error says what, and `tell` is not called.
    RealtimeThread(const RealtimeThreadConfig& config, std::function<void()> work,
                   const std::function<void(const RealtimeReport&)>& tell);

    void join() { thread_.join(); }
    // Returns the kernel's number of the thread, as pageFaultsOf takes it; -1 before it has started.
    pid_t id() const noexcept { return id_; }

  private:
    pid_t id_ = -1;
    std::jthread thread_;  // the last member: it is joined before anything else goes
};

}  // namespace bonemill
