// The iso-surface near the tool in pieces, and how finely each patch of it is cut.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "haptic_server/core/contact/cell_batch.h"
#include "haptic_server/core/contact/into_tool.h"
#include "haptic_server/core/contact/patch_id.h"
#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {

// It remembers how finely each patch near the tool is sampled. A patch that changed it while in contact would
// change the energy, so it keeps it until it is no longer near, unless there are too many samples.
//
// It is a table of fixed size, searched in a few slots per patch; a patch that finds no slot is new every
// time. It is RT-safe but for construction.
class PatchMemory {
  public:
    static constexpr uint8_t kNew = 255;

    // The memory is good for about half of most_patches, which is a power of two. It allocates.
    explicit PatchMemory(size_t most_patches) : slots_(most_patches) {}

    // From now on only patches that were asked for since the last call are known.
    void nextGathering() noexcept { ++gathering_; }
    void forget() noexcept { gathering_ += 2; }

    // The level of this patch: what is written stays for the next gathering. kNew: it is not known.
    uint8_t& levelOf(PatchId patch) noexcept {
        Slot* free = nullptr;
        for (size_t n = 0; n < kProbes; ++n) {
            Slot& slot = slots_[(home(patch) + n) & (slots_.size() - 1)];
            const bool is_known = slot.gathering + 1 >= gathering_;
            if (is_known && slot.patch == patch) {
                slot.gathering = gathering_;
                return slot.level;
            }
            if (!is_known && free == nullptr) free = &slot;
        }
        if (free == nullptr) return nowhere_ = kNew;
        *free = {patch, gathering_, kNew};
        return free->level;
    }

  private:
    struct Slot {
        PatchId patch;
        uint64_t gathering = 0;  // the last that asked for it
        uint8_t level = kNew;
    };
    static constexpr size_t kProbes = 8;
    static size_t home(PatchId patch) noexcept { return size_t(patch.packed() * 0x9E3779B97F4A7C15u >> 32); }

    std::vector<Slot> slots_;
    uint64_t gathering_ = 2;
    uint8_t nowhere_ = kNew;
};

// It is what is left of a piece that is cut no further.
struct SurfacePiece {
    Eigen::Vector3f centroid;  // m
    float area;                // m²
    float nearest;             // m: no place of it is nearer to the tool
    uint32_t patch;
};

// Cuts triangles of iso-surface near the tool into pieces that are small against the contact, however large
// the voxels are. The triangles of all cells tile the surface without gaps and overlaps, so their pieces do,
// too; that is what keeps a sum over them smooth when the tool slides (docs/explanation/accuracy.md).
//
// A piece is cut in two across its longest edge as long as that is longer than its limit: the sampling's
// spacing where the tool touches or nearly does, and in proportion to the distance away from it. Pieces that
// the tool cannot reach are dropped. Those that are too long wait in one list for each level of length, so
// that a piece is looked at again only when it is cut; many are cut at once (kernels/piece_loops.h).
//
// It is RT-safe but for construction, and for the tick thread only. Positions are in V's axes, from an
// origin.
class SurfacePieces {
  public:
    // A piece needs to be no shorter than a few times as long as it is far from the tool, but not so long
    // that a thin tool finds its way between two samples.
    static constexpr float kLengthPerDistance = 4;

    // The trilinear surface is taken to be no farther off a triangle, in voxels.
    static constexpr double kMostSag = 0.5;

    // It allocates room for N pieces, those that are cut or dropped later included.
    explicit SurfacePieces(size_t room);

    // Begins anew with no piece, around a tool at X_VT that may move by `margin` (m, as `fine_within` and
    // `spacing`, which is above 0).
    void start(const ToolField& tool, const Pose& X_VT, const Eigen::Vector3d& origin_V, double margin,
               double fine_within, double spacing) noexcept;
    // Adds the surface in a cell. A patch of level n is cut to the spacing times the n-th power of root 2.
    void add(const VoxelVolume& volume, const Eigen::Vector3i& cell, uint32_t patch, uint8_t level) noexcept;
    // Cuts all that was added, those of new patches to the spacing, or more coarsely, so that there are no
    // more than about most_of_new pieces in all. Returns their level. Other patches are cut to theirs as long
    // as there are no more than about `most`.
    uint8_t cut(const VoxelVolume& volume, size_t most_of_new, size_t most) noexcept;
    size_t count() const noexcept { return finished_count_; }
    // The last cut() left pieces that are too long.
    bool isCoarse() const noexcept { return is_coarse_ || is_full_; }
    // There was no room for all: some surface may be missing.
    bool isFull() const noexcept { return is_full_; }

    // Those whose samples the tool can reach, and those that there was no time or room to cut.
    std::span<const SurfacePiece> finished() const noexcept { return {finished_.data(), listed_count_}; }
    // Work since the last call, in distances of one point to the tool.
    size_t takePointTests() noexcept { return std::exchange(point_tests_, 0); }

  private:
    static constexpr int kNone = -1;
    static constexpr int kBatch = PointBatch<float>::kCapacity;
    static_assert(kBatch / 2 % kCellLanes == 0);  // their halves fit a batch

    void makeTriangles(const VoxelVolume& volume) noexcept;
    void sort(int first, int count, int gap = kNone, int behind_gap = kNone) noexcept;
    void cutAll(int level, bool has_room) noexcept;
    int takeSome(int level, bool has_room, int (&which)[kBatch / 2]) noexcept;
    void finish(int piece) noexcept;
    void finishAll(int level) noexcept;
    uint32_t patchOf(size_t piece) const noexcept { return patch_[size_t(triangle_[piece])]; }
    bool hasRoomFor(size_t more) const noexcept { return used_ + more + kBatch <= room_; }
    PieceArrays pieces() noexcept;
    SurfaceTriangles triangles(size_t from = 0) noexcept;

    const ToolField* tool_ = nullptr;
    IntoTool<float> into_tool_;
    PieceRules rules_{};
    Eigen::Matrix3f R_TV_ = Eigen::Matrix3f::Identity();
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
    // Cells whose triangles are not made yet.
    CellBatch cells_;
    alignas(64) float cell_x_[CellBatch::kMost], cell_y_[CellBatch::kMost], cell_z_[CellBatch::kMost];
    int cell_level_[CellBatch::kMost];
    uint32_t cell_patch_[CellBatch::kMost];
    // The triangles.
    std::vector<int> cases_;  // those of each set of inside corners
    std::vector<float> nx_, ny_, nz_, sag_, bend_;
    std::vector<int> cell_, finest_;
    std::vector<uint32_t> patch_;
    size_t triangle_count_ = 0;
    // All pieces that ever were, the first used_: each stays when it is cut, and its halves come behind.
    size_t room_;
    std::vector<float> corner_[9], area_, longest_, nearest_;
    std::vector<int> edge_, triangle_;
    size_t used_ = 0;
    // Linked lists of those that wait to be cut, by level.
    std::vector<int> next_;
    std::array<int, size_t(kPieceLevels)> first_;
    std::vector<SurfacePiece> finished_;  // the first listed_count_
    size_t listed_count_ = 0;
    size_t finished_count_ = 0;  // those out of the tool's reach are not listed
    size_t count_ = 0;           // finished or waiting
    bool is_coarse_ = false, is_full_ = false;
    size_t point_tests_ = 0;
};

}  // namespace bonemill
