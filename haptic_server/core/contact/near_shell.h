// Keeps, from gathering to gathering, which points of the shell are near the tool: there are ten times as
// many in the blocks that it reaches.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "common/geometry/pose.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

// Of each leaf of the shell it has a copy of the points that were nearer than the reach and kSkin more, in
// the shell's order. The copy is good until the tool has moved by the skin, or the leaf was written to; a
// leaf that is being milled has none. What is found with it is what is found without it.
//
// It is RT-safe but for construction, and for the tick thread only.
class NearShell {
  public:
    static constexpr double kSkin = 80e-6;  // m

    // It allocates room for about so many points; of what there is no room for, no copy is kept.
    explicit NearShell(size_t most_points);

    // This is called when the tool has another size, or points change without a write to the bone.
    void forget() noexcept;

    // Between these two each leaf is asked for at most once, in the lattice's order: for the points of a
    // level that are nearer than `reach` (m) to the tool.
    void begin(const PointShell& shell, int level, const ToolField& tool, const Pose& X_VT,
               double reach) noexcept;
    void end() noexcept;
    // Calls visit(const ShellBlock&, uint32_t count) for blocks of the leaf in which all these points are,
    // and others. The blocks are good until end().
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

    // Work since the last call, in distances of one point to the tool.
    size_t takePointTests() noexcept { return std::exchange(point_tests_, 0); }

  private:
    static constexpr uint32_t kNoBlock = ShellPool::kNoBlock;
    static constexpr size_t kMostLeaves = 512;
    static constexpr int kFewestUses = 4;   // of a copy, or it is not made
    static constexpr double kSlack = 1e-6;  // m: more than what is rounded off distances and ways
    struct KeptLeaf {
        LeafId leaf;
        uint32_t revision = 0;
        uint64_t gathering = 0;     // the last that asked for it
        bool has_points = false;    // else only the revision is known
        double good_until = 0;      // m: of travelled_ + reach_
        uint32_t first = kNoBlock;  // of blocks_
        uint32_t count = 0;         // points
    };
    void renewOldest() noexcept;
    const KeptLeaf* keep(LeafId leaf) noexcept;
    KeptLeaf* find(LeafId leaf) noexcept;
    bool copyNear(KeptLeaf& kept) noexcept;
    bool append(KeptLeaf& kept, uint32_t& last, const ShellBlock& from, int point) noexcept;
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
    double travelled_ = 0;  // m: of any point of the tool at the most, since the first gathering
    double reach_ = 0;      // m
    bool pays_ = false;     // the tool is slow enough for copies
    size_t point_tests_ = 0;
};

}  // namespace bonemill
