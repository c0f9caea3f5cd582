// Keeps, from gathering to gathering, which points of the shell are near the tool: there are ten times as
// many in the blocks that it reaches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/geometry/pose.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

// Of each leaf of the shell it has a copy of the points that were nearer than the reach, kSkin and the
// distances' error, in the shell's order. The copy is good until the tool's motion, or a larger reach, has
// used up the skin, or the leaf's points change; a leaf that is being milled has none. So all that the tool
// can touch is found as without it. Points that it cannot may differ: those of which a grid of distances
// knows only a bound.
//
// It is RT-safe but for construction, and for the tick thread only.
class NearShell {
  public:
    static constexpr double kSkin = 80e-6;  // m

    struct Gathering {
        const PointShell& shell;
        int level;
        const ToolField& tool;
        const Pose& X_VT;
        double margin;  // m: as far as the tool may move
        double reach;   // m: of the points that are asked for, margin included
    };

    // It allocates room for about so many points; of what there is no room for, no copy is kept.
    explicit NearShell(size_t most_points);
    NearShell(NearShell&&) = default;  // no copy: it would lose its room

    void forget() noexcept;
    // Without a motion the tool has come nearer to all bone by so much, m: it has grown.
    void comeNearer(double by) noexcept { travelled_ += by; }

    // Between these two each leaf is asked for at most once, in the lattice's order.
    void begin(const Gathering& gathering) noexcept;
    void end() noexcept;
    // Calls visit(const ShellBlock&, uint32_t count) for blocks of the leaf in which all points within the
    // reach are, and others. The blocks are good until end().
    template <class Visit>
    void forEachBlock(LeafId leaf, Visit&& visit) noexcept {
        const KeptLeaf* kept = keep(leaf);
        if (kept == nullptr) return shell_->forEachBlock(level_, leaf, visit);
        uint32_t left = kept->count;
        for (uint32_t block = kept->first; left > 0; block = blocks_[block].next) {
            const uint32_t count = std::min(left, ShellBlock::kCapacity);
            visit(std::as_const(blocks_[block]), count);
            left -= count;
        }
    }

    // Work since the last call, in distances of one point to the tool, and what was saved: what the tick has
    // time for must not depend on what happens to be kept.
    size_t takePointTests() noexcept { return std::exchange(point_tests_, 0); }

  private:
    static constexpr uint32_t kNoBlock = ShellPool::kNoBlock;
    static constexpr size_t kMostLeaves = 512;
    static constexpr int kFewestUses = 4;   // of a copy, or it is not made
    static constexpr double kSlack = 1e-6;  // m: more than what is rounded off distances and ways
    static constexpr double kFar = 1e-3;    // m: whoever goes so far in a step is elsewhere
    // Points that are looked at for copies in a gathering: they are made by and by, not all in one tick.
    static constexpr size_t kMostForCopies = 2048;
    struct KeptLeaf {
        LeafId leaf;
        uint32_t revision = 0;
        uint64_t gathering = 0;     // the last that asked for it
        bool has_points = false;    // else only the revision is known
        double good_until = 0;      // m: of travelled_ + reach_
        uint32_t first = kNoBlock;  // of blocks_
        uint32_t count = 0;         // points
        uint32_t looked_at = 0;     // points, for the copy
    };
    const KeptLeaf* keep(LeafId leaf) noexcept;
    KeptLeaf* find(LeafId leaf) noexcept;
    bool copyNear(KeptLeaf& kept) noexcept;
    bool append(KeptLeaf& kept, uint32_t& last, const ShellBlock& from, uint32_t point) noexcept;
    void release(KeptLeaf& kept) noexcept;

    std::vector<ShellBlock> blocks_;
    uint32_t free_ = kNoBlock;
    std::vector<KeptLeaf> leaves_;  // in the lattice's order
    size_t next_ = 0;               // of them: those before were asked for, or are not there any more
    uint64_t gathering_ = 0;
    // Of this gathering.
    const PointShell* shell_ = nullptr;
    int level_ = 0;
    const ToolField* tool_ = nullptr;
    Pose X_VT_;
    double reach_ = 0;      // m
    size_t allowance_ = 0;  // points that may still be looked at for copies
    double travelled_ = 0;  // m: of any point of the tool at the most, since it was forgotten
    size_t point_tests_ = 0;
};

}  // namespace bonemill
