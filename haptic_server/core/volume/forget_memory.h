// Gives the memory of samples that have been used back to the system before their owner goes.
#pragma once

#include <cstddef>
#include <span>

namespace bonemill {

// Only whole pages go; whatever they held reads as anything from now on. Does nothing when the system refuses
// (locked memory). It is not RT-safe.
void forgetBytes(std::span<std::byte> bytes) noexcept;

template <class T>
void forget(std::span<T> samples) noexcept {
    forgetBytes(std::as_writable_bytes(samples));
}

}  // namespace bonemill
