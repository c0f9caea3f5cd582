// Memory for the densities of a volume, brick by brick (kernels/brick_layout.h): all bricks of nothing but
// air share one, all of nothing but the densest bone another; only the rest has memory of its own.
//
// Voxels are named by u = index + 1 >= 0 on each axis here: the border of air has u = 0.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/kernels/brick_layout.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

// Memory for densities that can grow and shrink without being copied, so that there is never twice as much of
// it: a scan's bone takes gigabytes. It allocates, and is not RT-safe, but to read and to write what is
// there.
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

using Density = uint16_t;
inline constexpr Density kMaxDensity = 65535;

using BrickId = uint32_t;  // x fastest

class BrickStore {
  public:
    // It begins as air everywhere, for voxels u < `voxels` on each axis. It allocates.
    explicit BrickStore(const Eigen::Vector3i& voxels);

    const Eigen::Vector3i& bricksPerAxis() const noexcept { return bricks_; }
    size_t brickCount() const noexcept { return slots_.size(); }
    BrickId brickOf(int u, int v, int w) const noexcept {
        return brickAt(u >> kBrickShift, v >> kBrickShift, w >> kBrickShift);
    }
    BrickId brickAt(int x, int y, int z) const noexcept {
        BONEMILL_ASSERT(x >= 0 && x < bricks_.x() && y >= 0 && y < bricks_.y() && z >= 0 && z < bricks_.z());
        return BrickId(x + bricks_.x() * (y + bricks_.y() * z));
    }
    IndexBox allBricks() const noexcept { return {Eigen::Vector3i::Zero(), bricks_.array() - 1}; }

    // The offset is one in data(); the voxels from -kBrickLow to +kBrickHigh of the brick's first and last
    // one lie around it. It is RT-safe, for any thread; the brick that it leads to stays where it is until
    // it is opened.
    size_t offset(int u, int v, int w) const noexcept {
        constexpr int kInBrick = kBrickCells - 1;
        return slot(brickOf(u, v, w)) * kBrickSize + size_t((u & kInBrick) + kBrickLow) +
               kBrickStrideY * size_t((v & kInBrick) + kBrickLow) +
               kBrickStrideZ * size_t((w & kInBrick) + kBrickLow);
    }
    const Density* data() const noexcept { return pool_.data(); }
    Density* data() noexcept { return pool_.data(); }
    const uint32_t* slots() const noexcept { return slots_.data(); }

    // The contents begin with the first voxel that the brick holds, not with that of its first cell.
    Density* contents(BrickId brick) noexcept { return pool_.data() + size_t(slot(brick)) * kBrickSize; }
    const Density* contents(BrickId brick) const noexcept {
        return pool_.data() + size_t(slot(brick)) * kBrickSize;
    }
    // Returns the density of all in the brick, if it is a shared one.
    std::optional<Density> sharedDensity(BrickId brick) const noexcept {
        const uint32_t s = slot(brick);
        if (s >= kSharedSlots) return std::nullopt;
        return s == kAirSlot ? Density(0) : kMaxDensity;
    }

    // Bricks that open() can still give memory to.
    size_t spareCount() const noexcept { return pool_.size() / kBrickSize - used_; }
    size_t ownCount() const noexcept { return used_ - kSharedSlots; }
    size_t sharedCount() const noexcept { return brickCount() - ownCount(); }
    // Makes at least N spare ones, all their pages touched. Allocates and moves the data.
    void makeSpare(size_t count) {
        if (spareCount() < count) setPoolSize(used_ + count);
    }
    void dropSpare() { setPoolSize(used_); }
    BrickStore withoutSpare() const;

    // Gives a shared brick its own memory, with the same densities; needs a spare one. RT-safe; readers may
    // look meanwhile.
    void open(BrickId brick) noexcept;

    // This fills brick after brick: what was written to nextSpare(), which needs a spare one, becomes the
    // brick's; it is shared if it can be.
    Density* nextSpare() noexcept { return pool_.data() + used_ * kBrickSize; }
    void adoptNextSpare(BrickId brick) noexcept;

    // Lets every brick share that can. Allocates; moves the data.
    void shareUniformBricks();

  private:
    static constexpr uint32_t kAirSlot = 0, kSolidSlot = 1, kSharedSlots = 2;

    uint32_t slot(BrickId brick) const noexcept {
        return std::atomic_ref<uint32_t>(const_cast<uint32_t&>(slots_[brick]))
            .load(std::memory_order_acquire);
    }
    void setPoolSize(size_t bricks) { pool_.resize(bricks * kBrickSize); }

    Eigen::Vector3i bricks_;
    std::vector<uint32_t> slots_;  // per brick: where in the pool
    DensityPool pool_;
    size_t used_ = kSharedSlots;
};

}  // namespace bonemill
