// This is a bounded queue from one producer thread to one consumer thread. When it is full the new item is
// dropped and counted.
//
// tryPush() and tryPop() are wait-free and RT-safe; the constructor allocates. Any thread may read `dropped`.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace bonemill {

template <class T>
class SpscRing {
    static_assert(std::is_trivially_copyable_v<T>, "a push must not be able to allocate or throw");

  public:
    // It holds at least `capacity` items: as many as the next power of two.
    explicit SpscRing(size_t capacity)
        : mask_(std::bit_ceil(capacity < 1 ? size_t(1) : capacity) - 1), items_(new T[mask_ + 1]()) {}

    SpscRing(const SpscRing&) = delete;
    SpscRing& operator=(const SpscRing&) = delete;

    size_t capacity() const noexcept { return mask_ + 1; }

    // Only the producer may call it. False says that the ring was full; the item is dropped and counted.
    bool tryPush(const T& item) noexcept {
        const size_t tail = tail_.load(std::memory_order_relaxed);  // only this thread writes it
        if (tail - known_head_ > mask_) {
            known_head_ =
                head_.load(std::memory_order_acquire);  // pairs with tryPop's release: the slot is read
            if (tail - known_head_ > mask_) {
                dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
                return false;
            }
        }
        items_[tail & mask_] = item;
        tail_.store(tail + 1, std::memory_order_release);  // pairs with tryPop's acquire: the item is written
        return true;
    }

    // Only the consumer may call it. False says that nothing is there; `item` is untouched.
    bool tryPop(T& item) noexcept {
        const size_t head = head_.load(std::memory_order_relaxed);
        if (head == known_tail_) {
            known_tail_ = tail_.load(std::memory_order_acquire);
            if (head == known_tail_) return false;
        }
        item = items_[head & mask_];
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    // Counts the items refused since construction. It is a lone statistic, so that relaxed is enough.
    uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  private:
    static constexpr size_t kCacheLine = 64;

    const size_t mask_;
    const std::unique_ptr<T[]> items_;
    // Indices only ever grow. Each side keeps its last view of the other's beside its own, which spares the
    // other's cache line.
    alignas(kCacheLine) std::atomic<size_t> tail_{0};
    size_t known_head_ = 0;
    std::atomic<uint64_t> dropped_{0};
    alignas(kCacheLine) std::atomic<size_t> head_{0};
    size_t known_tail_ = 0;
};

}  // namespace bonemill
