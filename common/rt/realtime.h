// Makes the calling thread as real-time as this machine allows, and says in plain sentences what is missing.
//
// It is for start-up only, since it makes system calls and allocates. Nothing but RealtimeThread throws: the
// caller decides what a missing permission means (`--strict-rt`).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace bonemill {

inline constexpr int kAnyCore = -1;

// The machine's last core for n = 0, the one before for n = 1, ...; kAnyCore where there are fewer.
int coreFromLast(int n) noexcept;

struct RealtimeRequest {
    int priority = 80;    // SCHED_FIFO, 1..99; below the kernel's own 99, above interrupt threads (50)
    int core = kAnyCore;  // pin to this core, or leave the choice to the kernel
};

struct RealtimeReport {
    std::vector<std::string> missing;  // not granted: deadlines are best effort
    std::vector<std::string> advice;   // granted, but the machine is not set up to keep deadlines well

    void append(const RealtimeReport& other);
};

// Gives the calling thread SCHED_FIFO, pins it and prefaults its stack.
RealtimeReport makeThreadRealtime(const RealtimeRequest& request);

// From now on freed heap stays with the process: given back, its pages would be faulted in again by whoever
// asks for memory next. It is for programs that take and free megabytes again and again.
void keepFreedHeap() noexcept;
// Keeps all present and future pages of the process in memory, and freed heap with the process.
RealtimeReport lockMemory();

inline constexpr size_t kPrefaultedStackBytes = size_t(256) * 1024;
// Touches the stack below the caller so that the tick meets no page fault there.
void prefaultStack() noexcept;

struct RealtimeThreadConfig {
    RealtimeRequest request;
    bool is_strict = false;  // do not go on without what the machine does not grant
    std::string what = {};   // of messages: "the haptic loop"
};

// It is a thread that keeps deadlines, started the same way by every program that has one.
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

// How often a thread of this process had to wait for a page of memory. It is read from /proc, at any time.
struct PageFaults {
    uint64_t minor = 0;  // the page was in memory, and only had to be entered into the page table
    uint64_t major = 0;  // it came from a disk
};

// Counts since the thread's start; it returns nothing when there is no such thread. `thread` is
// what gettid() says.
std::optional<PageFaults> pageFaultsOf(pid_t thread);

}  // namespace bonemill
