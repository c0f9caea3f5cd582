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

bool ShellPool::replace(List& list, const BlockKeyBox& keys, const ShellPoints& fresh) noexcept {
    BONEMILL_ASSERT(fresh.count == 0 ||
                    (keys.contains(fresh.key[0]) && keys.contains(fresh.key[fresh.count - 1])));
    if (list.count == 0 && fresh.count == 0) return true;
    ++list.revision;
    const Place place = firstAtOrAbove(list, keys.first());
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
bool ShellPool::hasSameKeys(const List& list, const Place& from, const BlockKeyBox& keys,
                            const ShellPoints& fresh) const noexcept {
    size_t same = 0;
    uint32_t block = from.block;
    for (uint32_t before = from.before; before < list.count; before += kCapacity) {
        const ShellBlock& b = blocks_[block];
        const uint32_t count = std::min(kCapacity, list.count - before);
        for (uint32_t i = 0; i < count; ++i) {
            if (b.key[i] > keys.last()) return same == fresh.count;
            if (same < fresh.count && b.key[i] == fresh.key[same])
                ++same;
            else if (keys.contains(b.key[i]))
                return false;
        }
        block = b.next;
    }
    return same == fresh.count;
}

// The fresh points take the places of those with their keys.
void ShellPool::overwrite(const List& list, const Place& from, const ShellPoints& fresh) noexcept {
    size_t next = 0;
    uint32_t block = from.block;
    for (uint32_t before = from.before; next < fresh.count; before += kCapacity) {
        ShellBlock& b = blocks_[block];
        const uint32_t count = std::min(kCapacity, list.count - before);
        const size_t first = next;
        for (uint32_t i = 0; i < count && next < fresh.count; ++i)
            if (b.key[i] == fresh.key[next]) copyPoint(fresh, next++, b, i);
        if (next > first) setBounds(b, count);
        block = b.next;
    }
}

// Fills merged_ with what replaces the list's points from `from` on; returns how many those are. Ends early
// after a block from which on all points stay and would keep their places.
uint32_t ShellPool::merge(const List& list, const Place& from, const BlockKeyBox& keys,
                          const ShellPoints& fresh) noexcept {
    merged_size_ = 0;
    size_t next = 0;
    uint32_t block = from.block, read = 0;
    while (from.before + read < list.count) {
        const ShellBlock& b = blocks_[block];
        const uint32_t count = std::min(kCapacity, list.count - from.before - read);
        appendBelow(b.key[0], fresh, next);
        const bool is_after_all = b.key[0] > keys.last();  // also after all fresh ones
        if (is_after_all && merged_size_ == read) return read;
        if (is_after_all)
            append(b, 0, count);
        else
            mergeBlock(b, count, keys, fresh, next);
        read += count;
        block = b.next;
    }
    append(fresh, next, fresh.count - next);
    return read;
}

// Keeps the block's points outside the box `keys`, and before each run of them the fresh ones from
// fresh[next] on that belong there; those behind its last one are left.
void ShellPool::mergeBlock(const ShellBlock& b, uint32_t count, const BlockKeyBox& keys,
                           const ShellPoints& fresh, size_t& next) noexcept {
    for (uint32_t i = 0; i < count;) {
        if (keys.contains(b.key[i])) {
            ++i;
            continue;
        }
        appendBelow(b.key[i], fresh, next);
        uint32_t end = i + 1;
        while (end < count && !keys.contains(b.key[end]) &&
               !(next < fresh.count && fresh.key[next] < b.key[end]))
            ++end;
        append(b, i, end - i);
        i = end;
    }
}

// Appends the fresh points from `next` on whose keys are lower.
void ShellPool::appendBelow(const BlockKey& key, const ShellPoints& fresh, size_t& next) noexcept {
    const size_t first = next;
    while (next < fresh.count && fresh.key[next] < key) ++next;
    append(fresh, first, next - first);
}

template <class Points>
void ShellPool::append(const Points& from, size_t first, size_t count) noexcept {
    while (count > 0) {
        const uint32_t at = merged_size_ % kCapacity;
        const auto n = uint32_t(std::min<size_t>(count, kCapacity - at));
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
