// Bone that heat has killed: a bit for each cube of the heat grid (heat_grid.h), kept in bricks of cubes that
// outlive the warmth that killed them, until the bone itself is cut away.
//
// Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

class DeadCells {
  public:
    static constexpr int kShift = 3, kEdge = 1 << kShift, kCells = kEdge * kEdge * kEdge;  // of a brick

    // bricks is how many there are along each axis; dead cells of at most most_bricks of them are kept.
    DeadCells(const Eigen::Vector3i& bricks, size_t most_bricks);

    // The brick is inside the grid, and the cell one of its kCells, x first.
    void add(const Eigen::Vector3i& brick, int cell) noexcept;
    void remove(const Eigen::Vector3i& brick, int cell) noexcept;
    // False says that this brick has none.
    bool mayHave(const Eigen::Vector3i& brick) const noexcept { return slotOf(brick) != kNone; }
    void forget() noexcept;
    size_t count() const noexcept { return count_; }

    // This brick's bone, or all bone, may be gone: review() will look.
    void noteChange(const Eigen::Vector3i& brick) noexcept;
    void noteChangeEverywhere() noexcept { markStale(0, used_); }
    // Cells of which is_bone(cell in the grid) is false are not counted any more. It looks at no more than
    // most_lookups bricks' bone and returns how many they were.
    template <class IsBone>
    size_t review(size_t most_lookups, IsBone&& is_bone) noexcept {
        size_t lookups = 0;
        for (size_t n = 0; n < kMostSeen && stale_ > 0 && lookups < most_lookups; ++n) {
            next_ = next_ + 1 < used_ ? next_ + 1 : 0;
            Brick& brick = pool_[next_];
            if (!brick.is_stale) continue;
            brick.is_stale = false;
            --stale_;
            ++lookups;
            for (int cell = 0; cell < kCells; ++cell) {
                const Eigen::Vector3i place(cell & (kEdge - 1), cell >> kShift & (kEdge - 1),
                                            cell >> (2 * kShift));
                if (!brick.is_dead[size_t(cell)] || is_bone(brick.index * kEdge + place)) continue;
                brick.is_dead[size_t(cell)] = false;
                --count_;
            }
        }
        return lookups;
    }

  private:
    static constexpr uint32_t kNone = ~uint32_t(0);
    static constexpr size_t kMostSeen = 256;  // bricks that a review looks through for stale ones

    struct Brick {
        std::bitset<kCells> is_dead;
        Eigen::Vector3i index;
        bool is_stale;  // its bone may be gone
    };

    size_t directoryIndex(const Eigen::Vector3i& brick) const noexcept { return placeIn(bricks_, brick); }
    uint32_t slotOf(const Eigen::Vector3i& brick) const noexcept;
    void markStale(size_t first, size_t end) noexcept;

    Eigen::Vector3i bricks_;
    // A slot in the directory counts only while it is in use by that brick, so that all are forgotten at
    // once.
    std::vector<uint32_t> directory_;
    std::vector<Brick> pool_;
    size_t used_ = 0;              // of the pool
    size_t count_ = 0;             // of dead cells
    size_t stale_ = 0, next_ = 0;  // how many bricks are stale; where the search for them goes on
};

}  // namespace bonemill
