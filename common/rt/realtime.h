// Makes the calling thread as real-time as this machine allows, and says in plain sentences what is missing.
//
// It is for start-up only, since it makes system calls and allocates. Nothing throws: the caller decides what
// a missing permission means (`--strict-rt`).
#pragma once

#include <cstddef>
#include <string>
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

// Keeps all present and future pages of the process in memory, and freed heap with the process.
RealtimeReport lockMemory();

inline constexpr size_t kPrefaultedStackBytes = size_t(256) * 1024;
// Touches the stack below the caller so that the tick meets no page fault there.
void prefaultStack() noexcept;

}  // namespace bonemill
