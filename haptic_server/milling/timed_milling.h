// Removal and addition of material at a rate of density per time (thesis §4.2.2): voxels in the burr's reach
// lose or gain density until they are at the burr's limit (burr_limit.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "haptic_server/milling/burr_limit.h"
#include "haptic_server/milling/changed_runs.h"

namespace bonemill {

struct MillingConfig {
    bool enabled = true;
    double removal_rate =
        12750 * kDensityCountsPerUnit;  // density counts/s; default: from full to nothing in 20 ms
    double addition_rate = 12750 * kDensityCountsPerUnit;  // density counts/s
    MillingShape shape = MillingShape::kVoxelCentres;
    // In a tick; bricks for which there is no time wait for the next one, in turn.
    size_t most_cells = 50'000'000;  // whose surface is made anew; eight that are only looked at count as one
};

struct MillingResult {
    IndexBox changed;             // voxels whose density changed; empty if none
    uint32_t removed_voxels = 0;  // fell below the iso-value
    uint32_t added_voxels = 0;    // rose to the iso-value or above
    bool shell_is_complete = true;
    bool is_cut_short = false;  // most_cells were not enough
    bool has_room = true;       // false: no memory for some bricks to be changed, and they were not

    void include(const MillingResult& other) noexcept {
        changed.include(other.changed);
        removed_voxels += other.removed_voxels;
        added_voxels += other.added_voxels;
        shell_is_complete &= other.shell_is_complete;
        is_cut_short |= other.is_cut_short;
        has_room &= other.has_room;
    }
};

// Owns the scratch memory of the burr in use. Construction allocates; apply() is RT-safe (tick thread only).
class TimedMilling {
  public:
    // Room for burrs up to `largest_burr_radius`, which is the one in use at first.
    TimedMilling(const MillingConfig& config, const VoxelVolume& volume, const LeafLattice& lattice,
                 double largest_burr_radius);

    // Changes the voxels beyond their limit by rate·dt, but not past it, then the leaf versions, density
    // ranges and point-shell with them. direction -1 removes, +1 adds. p_VB: centre of the burr.
    MillingResult apply(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell,
                        const Eigen::Vector3d& p_VB, int direction, double dt) noexcept;

    // From the next apply() on.
    void setShape(MillingShape shape) noexcept { config_.shape = shape; }
    void setBurrRadius(double burr_radius) noexcept {
        const double radius = std::min(burr_radius, largest_burr_radius_);
        if (radius == burr_radius_) return;
        burr_radius_ = radius;
        next_leaf_ = kNoLeaf;
    }

  private:
    // What one tick mills.
    struct Stroke {
        Eigen::Vector3d p_VB;
        int direction, amount;
        BurrLimit limit;
    };
    void collectChanges(VoxelVolume& volume, const LeafLattice& lattice, const Stroke& stroke,
                        MillingResult& result) noexcept;
    int collectLeaf(VoxelVolume& volume, const IndexBox& voxels, int first_part, const Stroke& stroke,
                    MillingResult& result) noexcept;
    bool collectPart(VoxelVolume& volume, const IndexBox& part, size_t offset, const Stroke& stroke,
                     MillingResult& of_leaf) noexcept;
    void collectPlane(const VoxelVolume& volume, const IndexBox& plane, size_t offset, const Stroke& stroke,
                      MillingResult& result) noexcept;

    MillingConfig config_;
    double largest_burr_radius_;
    double burr_radius_;
    double carry_ = 0;  // fraction of a density count left over from earlier ticks, same direction
    int carry_direction_ = 0;
    ChangedRuns changes_;
    static constexpr LeafId kNoLeaf = ~LeafId(0);
    static constexpr int kAllParts = -1;
    LeafId next_leaf_ = kNoLeaf;  // where the last tick was cut short
    int next_part_ = 0;
    size_t cells_ = 0;  // of this tick
};

}  // namespace bonemill
