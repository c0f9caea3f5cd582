// Says in which of several ticks a leaf is milled, so that each of them has about as many patches to move.
// RT-safe; for the tick thread only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

class LeafTurns {
  public:
    // Leaves beyond these, and those that were not counted, take turns by their number.
    static constexpr size_t kMaxLeaves = 64;

    void clear() noexcept { count_ = 0; }
    // The leaf has so many patches more.
    void count(LeafId leaf, size_t patches) noexcept {
        const auto known = std::span(leaves_).first(count_);
        const auto at = std::ranges::find(known, leaf, &Leaf::id);
        if (at != known.end())
            at->patches += patches;
        else if (count_ < kMaxLeaves)
            leaves_[count_++] = {leaf, patches, 0};
    }
    // The leaves with the most patches come first; each goes where the fewest are.
    void share(size_t turns) noexcept {
        const auto leaves = std::span(leaves_).first(count_);
        std::ranges::sort(leaves, [](const Leaf& a, const Leaf& b) {
            return a.patches != b.patches ? a.patches > b.patches : a.id < b.id;
        });
        std::array<size_t, kMaxLeaves> patches{};
        const auto open = std::span(patches).first(std::min(turns, kMaxLeaves));
        for (Leaf& leaf : leaves) {
            const auto least = std::ranges::min_element(open);
            *least += leaf.patches;
            leaf.turn = size_t(least - open.begin());
        }
    }
    // Returns 0 .. turns-1; `turns` is that of share().
    size_t turnOf(LeafId leaf, size_t turns) const noexcept {
        for (size_t n = 0; n < count_; ++n)
            if (leaves_[n].id == leaf) return leaves_[n].turn;
        return leaf % turns;
    }

  private:
    struct Leaf {
        LeafId id;
        size_t patches;
        size_t turn;
    };
    std::array<Leaf, kMaxLeaves> leaves_;  // the first count_
    size_t count_ = 0;
};

}  // namespace bonemill
