// What other processes use of the machine.
#pragma once

#include <chrono>
#include <cstddef>

namespace bonemill::bench {

// So far, in its own code and in the kernel's.
double processorSeconds(int pid);

// Waits for so long, and returns the share of one core that the process had meanwhile.
double shareOfACore(int pid, std::chrono::seconds time);

size_t residentBytesOf(int pid);

}  // namespace bonemill::bench
