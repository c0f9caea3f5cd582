// Memory for densities that can grow and shrink without being copied, so that there is never twice as much of
// it: a scan's bone takes gigabytes. It allocates, and is not RT-safe, but to read and to write what is
// there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <span>

namespace bonemill {

class DensityPool {
  public:
    DensityPool() = default;
    explicit DensityPool(std::span<const uint16_t> densities) {
        reallocate(densities.size());
        if (size_ > 0) std::memcpy(data(), densities.data(), densities.size_bytes());
    }
    DensityPool(const DensityPool& other) : DensityPool({other.data(), other.size()}) {}
    DensityPool(DensityPool&& other) noexcept { swap(other); }
    DensityPool& operator=(DensityPool other) noexcept {
        swap(other);
        return *this;
    }

    size_t size() const noexcept { return size_; }
    uint16_t* data() noexcept { return memory_.get(); }
    const uint16_t* data() const noexcept { return memory_.get(); }

    // What is there stays, and may move; what is new is 0, its pages touched. Large blocks move by their
    // pages: the C library remaps them. Throws std::bad_alloc, and is as before then.
    void resize(size_t size) {
        const size_t before = size_;
        if (size != before) reallocate(size);
        if (size > before) std::memset(data() + before, 0, (size - before) * sizeof(uint16_t));
    }

  private:
    struct Free {
        void operator()(uint16_t* memory) const noexcept { std::free(memory); }
    };
    void reallocate(size_t size) {
        auto* const moved =
            static_cast<uint16_t*>(std::realloc(memory_.get(), (size + 1) * sizeof(uint16_t)));
        if (!moved) throw std::bad_alloc();
        static_cast<void>(memory_.release());
        memory_.reset(moved);
        size_ = size;
    }
    void swap(DensityPool& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
    }

    std::unique_ptr<uint16_t, Free> memory_;
    size_t size_ = 0;
};

}  // namespace bonemill
