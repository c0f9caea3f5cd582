// Gives the memory of samples that have been used back to the system before their owner goes.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace bonemill {

// Only whole pages go; whatever they held reads as anything from now on. Does nothing when the system refuses
// (locked memory). It is not RT-safe.
template <class T>
void forget(std::span<T> samples) noexcept {
    const std::span<std::byte> bytes = std::as_writable_bytes(samples);
    const auto page = uintptr_t(sysconf(_SC_PAGESIZE));
    const auto first = reinterpret_cast<uintptr_t>(bytes.data());
    const uintptr_t begin = (first + page - 1) / page * page, end = (first + bytes.size()) / page * page;
    if (begin < end) madvise(bytes.data() + (begin - first), end - begin, MADV_DONTNEED);
}

}  // namespace bonemill
