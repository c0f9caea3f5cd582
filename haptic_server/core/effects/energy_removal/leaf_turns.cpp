#include "haptic_server/core/effects/energy_removal/leaf_turns.h"

#include <algorithm>
#include <span>

namespace bonemill {

void LeafTurns::count(LeafId leaf, size_t patches) noexcept {
    const auto known = std::span(leaves_).first(count_);
    const auto at = std::ranges::find(known, leaf, &Leaf::id);
    if (at != known.end())
        at->patches += patches;
    else if (count_ < kMaxLeaves)
        leaves_[count_++] = {leaf, patches, 0};
}

void LeafTurns::share(size_t turns) noexcept {
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

size_t LeafTurns::turnOf(LeafId leaf, size_t turns) const noexcept {
    for (size_t n = 0; n < count_; ++n)
        if (leaves_[n].id == leaf) return leaves_[n].turn;
    return leaf % turns;
}

}  // namespace bonemill
