// These are the names of the shell's patches. A patch stands for the surface in one block of s×s×s
// cells (point_shell.h), and is named by the leaf and by the block's place in the leaf. They are
// RT-safe, for any thread.
#pragma once

#include <compare>
#include <cstdint>

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

struct PatchId {
    LeafId leaf = 0;
    BlockKey block;

    uint64_t packed() const noexcept { return uint64_t(leaf) << 32 | block.packed; }
    auto operator<=>(const PatchId&) const = default;
};
static_assert(sizeof(PatchId) == sizeof(uint64_t));

}  // namespace bonemill
