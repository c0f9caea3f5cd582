// These are the names of the shell's patches. A patch stands for the surface in one block of s×s×s
// cells (point_shell.h), and is named by the leaf and by the block's place in the leaf. They are
// RT-safe, for any thread.
#pragma once

#include <compare>
#include <cstdint>

#include "common/base/assert.h"
#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

// It is a block's index per axis, counted from the leaf's first block. The order is that of the
// blocks: x fastest.
struct BlockKey {
    static constexpr int kAxisBits = 10;
    static constexpr int kMaxPerAxis = 1 << kAxisBits;  // blocks of a leaf

    uint32_t packed = 0;

    static BlockKey of(const Eigen::Vector3i& index) noexcept {
        return {uint32_t(index.x() | index.y() << kAxisBits | index.z() << 2 * kAxisBits)};
    }
    Eigen::Vector3i index() const noexcept {
        constexpr uint32_t kMask = kMaxPerAxis - 1;
        return {int(packed & kMask), int(packed >> kAxisBits & kMask), int(packed >> 2 * kAxisBits & kMask)};
    }
    auto operator<=>(const BlockKey&) const = default;
};

// The keys of a box of blocks, which must not be empty.
class BlockKeyBox {
  public:
    explicit BlockKeyBox(const IndexBox& blocks) noexcept
        : first_(BlockKey::of(blocks.min)), last_(BlockKey::of(blocks.max)) {
        BONEMILL_ASSERT(!blocks.isEmpty() && blocks.min.minCoeff() >= 0 &&
                        blocks.max.maxCoeff() < BlockKey::kMaxPerAxis);
    }
    BlockKey first() const noexcept { return first_; }
    BlockKey last() const noexcept { return last_; }
    bool contains(BlockKey key) const noexcept {
        constexpr uint32_t kX = BlockKey::kMaxPerAxis - 1, kY = kX << BlockKey::kAxisBits,
                           kZ = kY << BlockKey::kAxisBits;
        return isWithin(key, kX) && isWithin(key, kY) && isWithin(key, kZ);
    }

  private:
    // What is below the first wraps around to beyond the last.
    bool isWithin(BlockKey key, uint32_t axis) const noexcept {
        const uint32_t first = first_.packed & axis;
        return (key.packed & axis) - first <= (last_.packed & axis) - first;
    }

    BlockKey first_, last_;
};

struct PatchId {
    LeafId leaf = 0;
    BlockKey block;

    uint64_t packed() const noexcept { return uint64_t(leaf) << 32 | block.packed; }
    auto operator<=>(const PatchId&) const = default;
};
static_assert(sizeof(PatchId) == sizeof(uint64_t));

}  // namespace bonemill
