// Lays material where a burr has been: what it sweeps is owed, and comes as soon as the tool has left it, so
// that the tool never stands in what it lays down. Owed places are kept around the burr, voxel by voxel;
// there a voxel rises at the rate, and at once where the burr has gone away.
//
// A voxel shall have the density of a ramp across the surface of the swept capsules (burr_limit.h), the most
// of all of them. It does not rise where the tool is nearer than the diagonal of a voxel: the surface between
// voxels is then outside of the tool. The tool counts as the capsule of the burr's radius from its centre
// along the shaft, so that a burr that has dived can move on sideways, too. As long as the stroke lasts, what
// has come makes way again where the tool comes back: those voxels fall to what they were, and are owed once
// more. The bone below stays as firm as it was.
//
// The frame is V, the units are SI. Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/milling/burr_limit.h"
#include "haptic_server/core/milling/change_collector.h"

namespace bonemill {

struct DepositConfig {
    double rate = 0;                 // density counts/s
    double largest_burr_radius = 0;  // m
    double longest_way = 0;          // m: of a burr in a tick
    size_t most_cells = 50'000'000;  // as MillingConfig
};

// The tool keeps this free: a capsule from the burr's centre on.
struct ToolPlace {
    Eigen::Vector3d p_VB = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis_V = Eigen::Vector3d::UnitY();  // unit, from the burr to the shaft
    double radius = 0;                                  // m: of the burr, or the shaft where that is thicker
    double way = 0;                                     // m: that it goes in a tick
};

class Deposit {
  public:
    Deposit(const BoneModel& bone, const DepositConfig& config);

    // The burr goes this way, and what it sweeps is owed from now on.
    void owe(const VoxelVolume& volume, const BurrWay& way, double burr_radius) noexcept;
    // Makes way for the tool if the stroke goes on, and lays down what is owed and free. Call it in each tick
    // that something is owed in. When the stroke has ended, what was laid down stays.
    MillingResult lay(BoneModel& bone, const ToolPlace& place, double dt, bool is_stroke) noexcept;

    bool isOwing() const noexcept { return used_count_ > 0; }
    void forget() noexcept;

  private:
    // What the voxels of a brick shall have, rows kBrickStrideY apart.
    static constexpr size_t kPlane = kBrickStrideY * kBrickCells;
    static constexpr size_t kBrick =
        kPlane * kBrickCells + kBrickStrideY;  // kernels read beyond the last row
    struct Slot {
        Eigen::Vector3i brick;
        IndexBox owed;            // voxels of the brick; empty: the slot is free
        bool is_left = false;     // there is something to lay in the next tick
        bool is_settled = false;  // all of it lies there
    };
    struct Stroke {
        BurrWay place;
        BurrLimit limit;
        int amount;
        IndexBox near;  // bricks in which the rate holds
    };

    static Eigen::Vector3i brickOf(const Eigen::Vector3i& voxel) noexcept {
        return (voxel.array() + 1).matrix().unaryExpr([](int u) { return u >> kBrickShift; });
    }
    size_t slotOf(const Eigen::Vector3i& brick) const noexcept;
    static size_t placeOf(size_t slot, const Eigen::Vector3i& voxel) noexcept;
    BurrPlane planeOf(const VoxelVolume& volume, const Eigen::Vector3i& first, const Stroke& stroke,
                      int amount) const noexcept;
    void clear(size_t slot) noexcept;
    size_t claim(const Eigen::Vector3i& brick) noexcept;
    IndexBox around(const VoxelVolume& volume, const Eigen::Vector3d& p_VB) const noexcept;
    IndexBox window(const VoxelVolume& volume, const Eigen::Vector3d& p_VB) const noexcept;
    void dropOutside(const IndexBox& bricks) noexcept;
    void raise(const VoxelVolume& volume, const IndexBox& part, const BurrWay& way,
               const BurrLimit& limit) noexcept;
    void makeWay(BoneModel& bone, const Stroke& stroke, const IndexBox& owed, MillingResult& result) noexcept;
    // Calls collect_part(part, slot) for the parts of a leaf that are owed.
    template <class CollectPart>
    int collectLeaf(const VoxelVolume& volume, const IndexBox& voxels, int first_part,
                    CollectPart&& collect_part) noexcept;
    bool lowerPart(VoxelVolume& volume, const IndexBox& part, const Stroke& stroke, Slot& slot,
                   MillingResult& of_leaf) noexcept;
    bool raisePart(VoxelVolume& volume, const IndexBox& part, const Stroke& stroke, Slot& slot,
                   MillingResult& of_leaf) noexcept;

    DepositConfig config_;
    Eigen::Vector3i slots_per_axis_;  // a torus of bricks around the burr
    std::vector<Slot> slots_;
    std::vector<Density> shall_;
    std::vector<Density> before_;  // of those that shall rise
    size_t used_count_ = 0;
    double carry_ = 0;  // counts
    ChangeCollector falling_, collector_;
};

}  // namespace bonemill
