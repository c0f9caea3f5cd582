// Stores the contact points in lists of fixed blocks from one pool, each list in ascending order of keys.
// Only growing the pool allocates; all else is RT-safe. It is for the tick thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "haptic_server/core/contact/shell_point.h"

namespace bonemill {

// It is a structure of arrays for the contact loop.
struct ShellBlock {
    static constexpr uint32_t kCapacity = 64;
    float x[kCapacity], y[kCapacity], z[kCapacity];
    float nx[kCapacity], ny[kCapacity], nz[kCapacity];
    float area[kCapacity];  // m²
    BlockKey key[kCapacity];
    uint32_t next;
    // A sphere lies around the block's points (V, m).
    float center[3], radius;
};

// Points side by side, as a ShellBlock has them, but as many as there are.
struct ShellPoints {
    const float *x, *y, *z;
    const float *nx, *ny, *nz;
    const float* area;
    const BlockKey* key;
    size_t count;
};

// From a ShellBlock or ShellPoints. The sphere around `to` stays what it was.
template <class Points>
void copyPoint(const Points& from, size_t point, ShellBlock& to, uint32_t at) noexcept {
    to.x[at] = from.x[point], to.y[at] = from.y[point], to.z[at] = from.z[point];
    to.nx[at] = from.nx[point], to.ny[at] = from.ny[point], to.nz[at] = from.nz[point];
    to.area[at] = from.area[point];
    to.key[at] = from.key[point];
}
template <class Points>
void copyPoints(const Points& from, size_t first, uint32_t count, ShellBlock& to, uint32_t at) noexcept {
    constexpr uint32_t kFew = 8;  // calls of memmove for each value would cost more
    if (count <= kFew) {
        for (uint32_t n = 0; n < count; ++n) copyPoint(from, first + n, to, at + n);
        return;
    }
    std::copy_n(from.x + first, count, to.x + at);
    std::copy_n(from.y + first, count, to.y + at);
    std::copy_n(from.z + first, count, to.z + at);
    std::copy_n(from.nx + first, count, to.nx + at);
    std::copy_n(from.ny + first, count, to.ny + at);
    std::copy_n(from.nz + first, count, to.nz + at);
    std::copy_n(from.area + first, count, to.area + at);
    std::copy_n(from.key + first, count, to.key + at);
}

class ShellPool {
  public:
    static constexpr uint32_t kNoBlock = ~0u;

    struct List {
        uint32_t first = kNoBlock;
        uint32_t count = 0;     // points
        uint32_t revision = 0;  // of the points
    };

    // A list can have at most `longest_list` points.
    explicit ShellPool(size_t longest_list) : merged_(longest_list / ShellBlock::kCapacity + 1) {}

    void addBlocks(size_t count);
    size_t blockCount() const noexcept { return blocks_.size(); }
    size_t freeCount() const noexcept { return free_count_; }

    // Replaces the points whose keys lie in the box `keys` by `fresh` (ascending, keys in that box). False
    // means that the pool is empty and the list stays as it was.
    bool replace(List& list, const BlockKeyBox& keys, const ShellPoints& fresh) noexcept;

    template <class Visit>
    void forEachBlock(const List& list, Visit&& visit) const noexcept {
        uint32_t left = list.count;
        for (uint32_t block = list.first; left > 0; block = blocks_[block].next) {
            const uint32_t count = left < ShellBlock::kCapacity ? left : ShellBlock::kCapacity;
            visit(blocks_[block], count);
            left -= count;
        }
    }

  private:
    // A place lies in a list at the start of a block; it is the block, what leads to it, and the points
    // before it.
    struct Place {
        uint32_t block;
        uint32_t previous;  // kNoBlock: the list's first
        uint32_t before;
    };
    Place firstAtOrAbove(const List& list, BlockKey key) const noexcept;
    bool hasSameKeys(const List& list, const Place& from, const BlockKeyBox& keys,
                     const ShellPoints& fresh) const noexcept;
    void overwrite(const List& list, const Place& from, const ShellPoints& fresh) noexcept;
    uint32_t merge(const List& list, const Place& from, const BlockKeyBox& keys,
                   const ShellPoints& fresh) noexcept;
    void mergeBlock(const ShellBlock& b, uint32_t count, const BlockKeyBox& keys, const ShellPoints& fresh,
                    size_t& next) noexcept;
    void appendBelow(const BlockKey& key, const ShellPoints& fresh, size_t& next) noexcept;
    template <class Points>
    void append(const Points& from, size_t first, size_t count) noexcept;
    void write(List& list, Place to) noexcept;
    void freeFrom(uint32_t block) noexcept;
    uint32_t takeBlock() noexcept;

    std::vector<ShellBlock> blocks_;
    uint32_t free_blocks_ = kNoBlock;
    size_t free_count_ = 0;
    std::vector<ShellBlock> merged_;  // scratch: the new points of a list from some place on
    uint32_t merged_size_ = 0;
};

}  // namespace bonemill
