// Moves the bone's surface into the bone by a given energy at each contact: a level-set shift of
// the densities.
//
// The energies of all contacts on one patch of the shell (point b, area a) make its recession s = E / (u a).
// To bring the iso-surface from b to b' = b - s n, the densities around b' must fall by the excess over the
// iso-value that they have there; all corners of a cell by the same, so that the ramp of densities keeps its
// slope. A voxel falls by the mean of what the patches around it ask for, weighted by area and distance
// (trilinear hat of the shell's block size); patches without contact ask for nothing, so that the surface
// beside the burr stays. Inside the burr they have no say: a crumb of some counts beside a rim would else
// outlast it, and hold the shaft that follows (but not where patches take turns, and may be in contact).
//
// What that removes is then measured: the sum over the cells of specific energy times the change of their
// fill (cell_fill.h). The sum telescopes: over a session it is that of what is missing in the end.
//
// The frame is V, the units are SI. Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/contact/cell_indices.h"
#include "haptic_server/core/milling/cell_fill.h"
#include "haptic_server/core/milling/cell_memory.h"
#include "haptic_server/core/milling/change_collector.h"
#include "haptic_server/core/milling/specific_energy.h"
#include "haptic_server/core/tool/burr.h"

namespace bonemill {

class SurfaceShift {
  public:
    // The surface moves no farther than this share of the thinnest voxel in a tick, times `ticks` of apply().
    static constexpr double kMaxShift = 0.25;

    // There is room for contacts no farther from the burr's centre than `largest_reach`, in m. most_cells is
    // that of MillingConfig.
    SurfaceShift(const BoneModel& bone, double largest_reach, size_t most_contacts, size_t most_cells);

    // Begins a new tick with the burr of the tool at this pose.
    void begin(const BoneModel& bone, const Burr& burr, const Pose& X_VT) noexcept;
    // Energy to be spent at one contact of this patch, J, and its depth, m: the patch
    // recedes no farther than its deepest contact reaches. It is quick when the contacts of a patch follow
    // each other.
    void add(const BoneModel& bone, PatchId patch, double energy, double depth) noexcept;
    // Spends `share` of the energies. Returns what was spent, J.
    double apply(BoneModel& bone, SpecificEnergy& u, double share, size_t ticks,
                 MillingResult& result) noexcept;

  private:
    // Of the patch whose block begins at this voxel.
    struct Order {
        float energy = 0, depth = 0;
    };
    // It is a point of the shell near those with energy; `at` in m, V, and the node of its block.
    struct NearPatch {
        Eigen::Vector3f at;
        float area;
        uint32_t node;
    };
    // Something was asked of these voxels of a row, one bit each from the scratch box on.
    using RowBits = uint64_t;
    static constexpr int kRowBits = 64;
    static constexpr size_t kNoNode = ~size_t(0);
    static constexpr int kSinkBatch = 2 * kCellLanes;
    struct Span {  // of voxels along x; empty: low > high
        int low = 1, high = 0;
    };

    size_t index(const Eigen::Vector3i& voxel) const noexcept { return placeIn(size_, voxel - first_); }
    // The row begins at this word; it has row_words_ words.
    size_t row(int j, int k) const noexcept {
        return size_t(row_words_) * (size_t(j - first_.y()) + size_t(size_.y()) * size_t(k - first_.z()));
    }
    bool isInScratch(const Eigen::Vector3i& voxel) const noexcept;

    void findPatches(const BoneModel& bone) noexcept;
    void spreadWishes(const BoneModel& bone, SpecificEnergy& u, double share, double most) noexcept;
    void spread(const VoxelVolume& volume, const SinkingPoints& wishes, const float* areas) noexcept;
    void spreadRest(const BoneModel& bone) noexcept;
    void leaveOutRestInsideBurr(const VoxelVolume& volume) noexcept;
    // Places whose hats are looked at together, in voxel steps.
    struct Hats {
        alignas(64) float x[kSinkBatch], y[kSinkBatch], z[kSinkBatch];
        alignas(64) int first[3][kSinkBatch], count[3][kSinkBatch];
    };
    void findBoxes(Hats& hats, int count) const noexcept;
    VoxelHat hatOf(const Hats& hats, int n) const noexcept;
    void addRest(Hats& hats, const float* areas, int count) noexcept;
    template <class Visit>
    bool forEachRow(const VoxelHat& hat, Visit&& visit) const noexcept;
    template <class Visit>
    void forEachCell(const VoxelVolume& volume, Visit&& visit) const noexcept;
    void findCells(const VoxelVolume& volume) noexcept;
    void measureAgain(const VoxelVolume& volume) noexcept;
    void touch(const VoxelHat& hat) noexcept;
    void forgetVoxel(const Eigen::Vector3i& voxel) noexcept;
    bool isAnyTouched(const VoxelHat& hat) const noexcept;
    Span touchedIn(size_t row, int low, int high) const noexcept;
    void collect(BoneModel& bone, MillingResult& result) noexcept;
    bool collectLeaf(VoxelVolume& volume, const IndexBox& voxels, MillingResult& of_leaf) noexcept;
    void collectRow(const VoxelVolume& volume, const Eigen::Vector3i& first, int count, ChangedRuns& rows,
                    MillingResult& of_part) noexcept;
    void forget() noexcept;

    CellFills fills_;
    Eigen::Vector3i size_;                             // of the scratch box
    Eigen::Vector3i first_ = Eigen::Vector3i::Zero();  // its first voxel
    IndexBox room_;                                    // of voxels that can be written
    Burr burr_;
    Pose X_VT_;
    int block_ = 1;  // of the shell in force, in voxels
    std::vector<Order> orders_;
    // Voxel by voxel: the weighted sum of what is asked for, and of the weights; negative where the rest has
    // no say.
    std::vector<float> drops_, weights_;
    int row_words_;
    std::vector<RowBits> asked_;   // row by row: voxels that something was asked of
    IndexBox touched_;             // all of those
    std::vector<size_t> patches_;  // nodes with energy; the first patch_count_
    size_t patch_count_ = 0;
    PatchId last_patch_;  // of add(), and its node; kNoNode: none yet
    size_t last_node_ = kNoNode;
    LeafId leaf_ = ~LeafId(0);  // of the last patch with one, and its first cell
    Eigen::Vector3i leaf_first_ = Eigen::Vector3i::Zero();
    std::vector<NearPatch> near_;  // the first near_count_
    size_t near_count_ = 0;
    IndexBox patch_cells_;  // blocks of those begin in it
    // Cells with a touched voxel that may have some bone, and the shares of them that are bone.
    CellIndices cells_;
    std::vector<float> fills_before_, fills_after_;
    std::vector<int> inside_;  // their corners inside the bone, bit by corner
    CellIndices unknown_;      // those of cells_ that known_bone_ does not know, and their places there
    std::vector<size_t> unknown_at_;
    struct CellBone {
        float fill;
        bool at_corners;
    };
    CellMemory<CellBone> known_bone_;  // as long as nobody else writes
    uint64_t known_at_write_ = 0;      // the lattice's after the last own one
    std::vector<Density> old_, fresh_;
    ChangeCollector collector_;
    bool is_too_fast_ = false;
    double rounding_ = 0;  // 0 .. 1, another one each tick: what is less than a count is not lost
};

}  // namespace bonemill
