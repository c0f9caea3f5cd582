// Finds where the bone lies and what floats beside it, and takes that away: noise, pieces of the headrest,
// wires.
//
// A piece is what is connected through voxel faces (6 neighbours) at or above the iso-value. For start-up
// only: not RT-safe, allocates 16 bytes per run of such voxels along x, and BonePiece per piece.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct BonePiece {
    uint64_t voxels = 0;
    IndexBox box;                                      // voxels
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // mean of its voxels' indices
};

class BonePieces {
  public:
    explicit BonePieces(const VoxelVolume& volume);
    ~BonePieces();

    // The largest comes first; of two alike the one with the lower voxel, z before y before x.
    std::span<const BonePiece> list() const noexcept { return pieces_; }
    // Has the piece of this place in the list a voxel in the box?
    std::vector<bool> touching(const IndexBox& box) const;

    // Goes through all bone, row by row: each call is `length` voxels along x, of the piece of this place.
    using SeeRun = std::function<void(size_t piece, const Eigen::Vector3i& first, int length)>;
    void forEachRun(const SeeRun& see) const;

    using See = std::function<void(const Eigen::Vector3i& voxel)>;
    // The volume is that of the constructor. Pieces for whose place in the list is_dropped is true go to iso
    // - 1, just below the surface, so that nothing of them is felt or drawn. Returns how many voxels that
    // were; `see` gets each.
    uint64_t drop(VoxelVolume& volume, const std::vector<bool>& is_dropped, const See& see = {}) const;

  private:
    class Runs;
    std::unique_ptr<const Runs> runs_;
    std::vector<BonePiece> pieces_;
    std::vector<uint32_t> piece_of_run_;  // place in the list
};

// For people: number, size and place in W. Numbers begin at 1.
std::string textOf(const BonePiece& piece, size_t number, const VolumeGeometry& geometry);

// Drops the pieces with fewer voxels than that; returns how many voxels that were.
uint64_t removeSmallPieces(VoxelVolume& volume, uint32_t smallest_piece_voxels);

// The voxels that bone reaches to; empty without bone. Looks at every voxel that is not air all around.
IndexBox boneBox(const VoxelVolume& volume);

// Its middle voxels' places in V, m.
Eigen::AlignedBox3d placesOf(const IndexBox& voxels, const Eigen::Vector3d& spacing);

// Volumes in what people read: m³ as mm^3: three digits, or all that are before the point.
std::string volumeText(double cubic_metres);

// Edges as "0.957 x 0.957 x 1.5", numbers of voxels as "256 x 256 x 108".
std::string edgesText(const Eigen::Vector3d& edges);

}  // namespace bonemill
