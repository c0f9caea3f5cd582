// How much memory this process may still take: what the machine has free, or less where a control group (a
// container, a service) limits it. There is no Eigen in here: ITK's sources include its neighbours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace bonemill {

struct FreeMemory {
    uint64_t bytes = 0;  // 0: nothing is known, which means no limit
    std::string limit;   // for people, "a limit of 512 MiB on /docker/1"; empty: the machine's memory is all

    bool holds(uint64_t needed) const { return bytes == 0 || needed <= bytes; }
    // "only 210 MiB of memory are free (a limit of 512 MiB on /docker/1)".
    std::string text() const;
};

// Of control groups of version 1 and 2, and of all groups around this process's own, the one with the least
// counts. What the kernel would give up first (cached files) counts as free. `proc` is another folder in
// tests.
// A hard limit of the address space (ulimit -v) counts like a group's.
FreeMemory freeMemory(const std::filesystem::path& proc = "/proc");

// This limit of the address space is this process's own (capMemoryForGood) and no news. For one thread.
void noteOwnAddressLimit(uint64_t bytes) noexcept;

}  // namespace bonemill
