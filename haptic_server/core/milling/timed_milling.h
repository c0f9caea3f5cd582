// Removal and addition of material at a rate of density per time (thesis §4.2.2): voxels in the burr's reach
// lose or gain density until they are at the burr's limit (burr_limit.h).
//
// With the shape kVoxelCentres that is what the thesis says: each voxel at the rate. With kSubVoxel the rate
// says how fast the surface moves, whatever the voxels: as fast as the fastest burr under which a place in
// the middle of its way goes from full to nothing at the rate, v = 2 R rate / full. (Each voxel at the rate
// would make it rate / slope, which goes with the voxels' size.)
#pragma once

#include <algorithm>

#include "haptic_server/core/milling/burr_limit.h"
#include "haptic_server/core/milling/change_collector.h"

namespace bonemill {

struct MillingConfig {
    double removal_rate = 0;   // density counts/s
    double addition_rate = 0;  // density counts/s
    MillingShape shape = MillingShape::kVoxelCentres;
    // A tick makes the surface of N cells anew; bricks for which there is no time wait for the next
    // one, in turn.
    size_t most_cells = 50'000'000;  // whose surface is made anew; eight that are only looked at count as one
    double longest_way = 0;          // m: of a burr in a tick
};

// Owns the scratch memory of the burr in use. Construction allocates; apply() is RT-safe, for the
// tick thread only.
class TimedMilling {
  public:
    // There is room for burrs up to `largest_burr_radius`, which is the one in use at first.
    TimedMilling(const MillingConfig& config, const VoxelVolume& volume, const LeafLattice& lattice,
                 double largest_burr_radius);

    // Changes the voxels beyond their limit by what the rate makes in dt, but not past it, then the leaf
    // versions, density ranges and point-shell with them. direction -1 removes, +1 adds. p_VB: centre of the
    // burr.
    MillingResult apply(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell,
                        const Eigen::Vector3d& p_VB, int direction, double dt) noexcept {
        return apply(volume, lattice, shell, BurrWay(p_VB), direction, dt);
    }
    // This does so along a burr's way, which may be `longest_way` long. What there was no time for in the
    // ticks before comes with it.
    MillingResult apply(VoxelVolume& volume, LeafLattice& lattice, PointShell& shell, const BurrWay& way,
                        int direction, double dt) noexcept;

    // This is v above, m/s: the burr in use removes at this speed.
    double removalSpeed() const noexcept { return speedAt(config_.removal_rate); }

    // These take effect with the next apply().
    void setShape(MillingShape shape) noexcept { config_.shape = shape; }
    // There may be so many cells of the surface divided by 2 to this power.
    void setThrift(int thrift) noexcept { collector_.limit(config_.most_cells >> thrift); }
    void setBurrRadius(double burr_radius) noexcept {
        const double radius = std::min(burr_radius, largest_burr_radius_);
        if (radius == burr_radius_) return;
        burr_radius_ = radius;
        collector_.forgetTurn();
    }

  private:
    // A stroke is what one tick mills.
    struct Stroke {
        BurrWay way;
        int direction, amount;
        BurrLimit limit;

        bool isOutOfReach(const VoxelVolume& volume, const IndexBox& voxels) const noexcept;
    };
    double speedAt(double rate) const noexcept { return 2 * burr_radius_ * rate / kMaxDensity; }
    double countsOf(double rate, const BurrLimit& limit, double dt) const noexcept;
    void collectChanges(VoxelVolume& volume, const LeafLattice& lattice, const Stroke& stroke,
                        MillingResult& result) noexcept;
    bool collectPart(VoxelVolume& volume, const IndexBox& part, size_t offset, const Stroke& stroke,
                     MillingResult& of_leaf) noexcept;
    static void collectPlane(const VoxelVolume& volume, const IndexBox& plane, size_t offset,
                             const Stroke& stroke, ChangedRuns& rows, MillingResult& of_part) noexcept;

    MillingConfig config_;
    double largest_burr_radius_;
    double burr_radius_;
    double carry_ =
        0;  // counts left over from earlier ticks, same direction: a fraction, or what had no time
    int carry_direction_ = 0;
    ChangeCollector collector_;
};

}  // namespace bonemill
