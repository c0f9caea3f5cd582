#include "haptic_server/core/contact/shell_pool.h"

#include <algorithm>
#include <cmath>

#include "common/base/assert.h"

namespace bonemill {
namespace {

constexpr uint32_t kCapacity = ShellBlock::kCapacity;

uint32_t blocksFor(uint32_t points) noexcept {
    return (points + kCapacity - 1) / kCapacity;
}

bool isInside(BlockKey key, const IndexBox& keys) noexcept {
    const Eigen::Vector3i at = key.index();
    return (at.array() >= keys.min.array()).all() && (at.array() <= keys.max.array()).all();
}

void put(const ShellPoint& point, ShellBlock& b, uint32_t i) noexcept {
    b.x[i] = point.position.x(), b.y[i] = point.position.y(), b.z[i] = point.position.z();
    b.nx[i] = point.normal.x(), b.ny[i] = point.normal.y(), b.nz[i] = point.normal.z();
    b.area[i] = point.area;
    b.key[i] = point.key;
}

void setBounds(ShellBlock& b, uint32_t count) noexcept {
    const auto first = [count](const float* values) {
        return Eigen::Map<const Eigen::ArrayXf>(values, count);
    };
    float squared = 0;
    const float* const axes[3] = {b.x, b.y, b.z};
    for (int axis = 0; axis < 3; ++axis) {
        const float low = first(axes[axis]).minCoeff(), high = first(axes[axis]).maxCoeff();
        b.center[axis] = (low + high) / 2;
        squared += (high - low) * (high - low);
    }
    b.radius = std::sqrt(squared) / 2;
}

}  // namespace

void ShellPool::addBlocks(size_t count) {
    const size_t old = blocks_.size();
    blocks_.resize(old + count);
    for (size_t b = old; b < blocks_.size(); ++b) {
        blocks_[b].next = free_blocks_;
        free_blocks_ = uint32_t(b);
    }
    free_count_ += count;
}

bool ShellPool::replace(List& list, const IndexBox& keys, std::span<const ShellPoint> fresh) noexcept {
    if (list.count == 0 && fresh.empty()) return true;
    ++list.revision;
    const Place place = firstAtOrAbove(list, BlockKey::of(keys.min));
    if (hasSameKeys(list, place, keys, fresh)) {
        overwrite(list, place, fresh);
        return true;
    }
    const uint32_t replaced = merge(list, place, keys, fresh);
    // There may be as many points as before; then what follows stays where it is.
    const uint32_t count = list.count - replaced + merged_size_;
    const uint32_t have = blocksFor(list.count);
    const uint32_t want = blocksFor(count);
    if (want > have && want - have > free_count_) return false;
    list.count = count;
    write(list, place);
    return true;
}

ShellPool::Place ShellPool::firstAtOrAbove(const List& list, BlockKey key) const noexcept {
    Place place{list.first, kNoBlock, 0};
    while (list.count - place.before > kCapacity && blocks_[place.block].key[kCapacity - 1] < key)
        place = {blocks_[place.block].next, place.block, place.before + kCapacity};
    return place;
}

// Among the list's points from `from` on, are the keys in the box those of the fresh points?
bool ShellPool::hasSameKeys(const List& list, const Place& from, const IndexBox& keys,
                            std::span<const ShellPoint> fresh) const noexcept {
    const BlockKey last_key = BlockKey::of(keys.max);
    size_t same = 0;
    uint32_t block = from.block;
    for (uint32_t before = from.before; before < list.count; before += kCapacity) {
        const ShellBlock& b = blocks_[block];
        const uint32_t count = std::min(kCapacity, list.count - before);
        for (uint32_t i = 0; i < count; ++i) {
            if (b.key[i] > last_key) return same == fresh.size();
            if (same < fresh.size() && b.key[i] == fresh[same].key)
                ++same;
            else if (isInside(b.key[i], keys))
                return false;
        }
        block = b.next;
    }
    return same == fresh.size();
}

// The fresh points take the places of those with their keys.
void ShellPool::overwrite(const List& list, const Place& from, std::span<const ShellPoint> fresh) noexcept {
    size_t next = 0;
    uint32_t block = from.block;
    for (uint32_t before = from.before; next < fresh.size(); before += kCapacity) {
        ShellBlock& b = blocks_[block];
        const uint32_t count = std::min(kCapacity, list.count - before);
        const size_t first = next;
        for (uint32_t i = 0; i < count && next < fresh.size(); ++i)
            if (b.key[i] == fresh[next].key) put(fresh[next++], b, i);
        if (next > first) setBounds(b, count);
        block = b.next;
    }
}

// Fills merged_ with what replaces the list's points from `from` on; returns how many those are. Ends early
// after a block from which on all points stay and would keep their places.
uint32_t ShellPool::merge(const List& list, const Place& from, const IndexBox& keys,
                          std::span<const ShellPoint> fresh) noexcept {
    const BlockKey last_key = BlockKey::of(keys.max);
    merged_size_ = 0;
    size_t next = 0;
    uint32_t block = from.block, read = 0;
    while (from.before + read < list.count) {
        const ShellBlock& b = blocks_[block];
        const uint32_t count = std::min(kCapacity, list.count - from.before - read);
        const bool is_after_all = next == fresh.size() && b.key[0] > last_key;
        if (is_after_all && merged_size_ == read) return read;
        if (is_after_all)
            append(b, 0, count);
        else
            mergeBlock(b, count, keys, fresh, next);
        read += count;
        block = b.next;
    }
    while (next < fresh.size()) append(fresh[next++]);
    return read;
}

// Keeps the block's points outside the box `keys`, and between them the fresh ones from fresh[next] on, as
// far as they belong there.
void ShellPool::mergeBlock(const ShellBlock& b, uint32_t count, const IndexBox& keys,
                           std::span<const ShellPoint> fresh, size_t& next) noexcept {
    uint32_t first = 0;  // of the points that stay and are not yet appended
    for (uint32_t i = 0; i < count; ++i) {
        const bool is_replaced = isInside(b.key[i], keys);
        if (!is_replaced && !(next < fresh.size() && fresh[next].key < b.key[i])) continue;
        append(b, first, i - first);
        while (next < fresh.size() && fresh[next].key < b.key[i]) append(fresh[next++]);
        first = is_replaced ? i + 1 : i;
    }
    append(b, first, count - first);
}

void ShellPool::append(const ShellPoint& point) noexcept {
    put(point, merged_[merged_size_ / kCapacity], merged_size_ % kCapacity);
    ++merged_size_;
}

void ShellPool::append(const ShellBlock& from, uint32_t first, uint32_t count) noexcept {
    while (count > 0) {
        const uint32_t at = merged_size_ % kCapacity, n = std::min(count, kCapacity - at);
        copyPoints(from, first, n, merged_[merged_size_ / kCapacity], at);
        merged_size_ += n, first += n, count -= n;
    }
}

// Writes merged_ from `to` on and gives the list as many blocks as its count wants.
void ShellPool::write(List& list, Place to) noexcept {
    for (uint32_t n = 0; n < merged_size_; n += kCapacity) {
        const bool is_new = to.block == kNoBlock;
        if (is_new) {
            to.block = takeBlock();
            (to.previous == kNoBlock ? list.first : blocks_[to.previous].next) = to.block;
        }
        ShellBlock& b = blocks_[to.block];
        const uint32_t count = std::min(kCapacity, merged_size_ - n);
        copyPoints(merged_[n / kCapacity], 0, count, b, 0);
        setBounds(b, count);
        to.previous = to.block;
        to.block = b.next;
    }
    if (to.before + merged_size_ < list.count) return;  // the rest stays
    freeFrom(to.block);
    (to.previous == kNoBlock ? list.first : blocks_[to.previous].next) = kNoBlock;
}

void ShellPool::freeFrom(uint32_t block) noexcept {
    while (block != kNoBlock) {
        const uint32_t next = blocks_[block].next;
        blocks_[block].next = free_blocks_;
        free_blocks_ = block;
        ++free_count_;
        block = next;
    }
}

uint32_t ShellPool::takeBlock() noexcept {
    BONEMILL_ASSERT(free_count_ > 0 && free_blocks_ != kNoBlock);
    const uint32_t block = free_blocks_;
    free_blocks_ = blocks_[block].next;
    blocks_[block].next = kNoBlock;
    --free_count_;
    return block;
}

}  // namespace bonemill
