// Says in which of several ticks a leaf is milled, so that each of them has about as many patches to move.
// RT-safe; for the tick thread only.
#pragma once

#include <array>
#include <cstddef>

#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

class LeafTurns {
  public:
    // Leaves beyond these, and those that were not counted, take turns by their number.
    static constexpr size_t kMaxLeaves = 64;

    void clear() noexcept { count_ = 0; }
    // The leaf has so many patches more.
    void count(LeafId leaf, size_t patches) noexcept;
    // The leaves with the most patches come first; each goes where the fewest are.
    void share(size_t turns) noexcept;
    // Returns 0 .. turns-1; `turns` is that of share().
    size_t turnOf(LeafId leaf, size_t turns) const noexcept;

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
