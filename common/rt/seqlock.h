// Carries the newest value from one writer to any number of readers, also across processes: the object may
// lie in shared memory.
//
// write() is wait-free, tryRead() is bounded, and both are RT-safe. All-zero memory is a valid Seqlock that
// was never written. Every byte travels in atomic words, so a concurrent read is no data race. No fence is
// needed: a reader that sees a word of an unfinished write (acquire, paired with the word's release) also
// sees the odd counter before it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace bonemill {

template <class T>
class Seqlock {
    static_assert(std::is_trivially_copyable_v<T>);
    static_assert(std::atomic<uint32_t>::is_always_lock_free && std::atomic<uint64_t>::is_always_lock_free);

  public:
    static constexpr int kDefaultAttempts =
        16;  // a write lasts some ten nanoseconds, so the second one succeeds

    // Only the one writer may call it. It also repairs the counter that a writer left odd when it died.
    void write(const T& value) noexcept {
        Words words{};
        std::memcpy(words.data(), &value, sizeof(T));
        const uint32_t busy = counter_.load(std::memory_order_relaxed) | 1u;
        counter_.store(busy, std::memory_order_relaxed);
        for (size_t i = 0; i < kWords; ++i) body_[i].store(words[i], std::memory_order_release);
        const uint32_t done = busy + 1;
        counter_.store(done == kNeverWritten ? done + 2 : done, std::memory_order_release);
    }

    // Any reader may call it. False says that nothing was written yet, or that every attempt met a write;
    // `value` is untouched then. `version`, if given, receives the counter of the value read, which differs
    // between two writes.
    bool tryRead(T& value, uint32_t* version = nullptr, int attempts = kDefaultAttempts) const noexcept {
        for (int attempt = 0; attempt < attempts; ++attempt) {
            const uint32_t before = counter_.load(std::memory_order_acquire);
            if (before == kNeverWritten) return false;
            if (before & 1u) continue;
            Words words;
            for (size_t i = 0; i < kWords; ++i) words[i] = body_[i].load(std::memory_order_acquire);
            if (counter_.load(std::memory_order_relaxed) != before) continue;
            std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
            if (version) *version = before;
            return true;
        }
        return false;
    }

    // The counter is odd while a write is under way, and 0 before the first one. A futex may wait on it.
    const std::atomic<uint32_t>& counter() const noexcept { return counter_; }

    static constexpr uint32_t kNeverWritten = 0;

  private:
    static constexpr size_t kWords = (sizeof(T) + sizeof(uint64_t) - 1) / sizeof(uint64_t);
    using Words = std::array<uint64_t, kWords>;

    std::atomic<uint32_t> counter_{kNeverWritten};
    std::array<std::atomic<uint64_t>, kWords> body_{};
};

}  // namespace bonemill
