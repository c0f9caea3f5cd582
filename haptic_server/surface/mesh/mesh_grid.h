// The vertices of all node meshes lie on an integer grid: the same point is the same integer in every leaf.
//
// A cell is stepsPerCell() steps wide on each axis; steps 0 are voxel (0, 0, 0), and voxel (i, j, k) lies at
// stepsPerCell() * (i, j, k). Thread-safe after construction; the lattice must outlive it.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "common/geometry/node_mesh.h"
#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

// Steps from the low voxel to the iso-value, rounded to nearest; low and high lie on different sides of iso.
// At most kMaxStepsPerCell of MeshGrid per cell.
inline int stepsToIso(Density low, Density high, Density iso, int steps_per_cell) noexcept {
    const uint32_t rise = uint32_t(std::abs(int(high) - int(low)));
    const uint32_t to_iso = uint32_t(std::abs(int(iso) - int(low)));
    const uint32_t steps = (2 * to_iso * uint32_t(steps_per_cell) + rise) / (2 * rise);
    return std::clamp(int(steps), 1, steps_per_cell - 1);
}

class MeshGrid {
  public:
    static constexpr int kMaxStepsPerCell = 16383;  // 32 bits hold a density times that (stepsToIso)
    static_assert(2 * uint64_t(kMaxDensity) * kMaxStepsPerCell + kMaxDensity <= UINT32_MAX);
    // This is streamed. The cell fills a high byte and the place in it a low one, which packs best.
    static constexpr int kStreamedStepsPerCell = 256;

    // Throws std::invalid_argument when a leaf is so large (over 21845 cells) that 16 bits cannot hold
    // its vertices.
    MeshGrid(const VoxelVolume& volume, const LeafLattice& lattice,
             int most_steps_per_cell = kMaxStepsPerCell)
        : lattice_(lattice),
          steps_per_cell_(std::min(most_steps_per_cell, kMaxLocalSteps / lattice.leafCells().maxCoeff())),
          spacing_(volume.spacing()),
          step_(spacing_ / steps_per_cell_) {
        if (steps_per_cell_ < kMinStepsPerCell) throw std::invalid_argument("octree leaf too large to mesh");
    }

    int stepsPerCell() const noexcept { return steps_per_cell_; }

    // This is the first cell's low corner, in V and m, and the same in steps.
    Eigen::Vector3f leafOrigin(LeafId leaf) const noexcept {
        return spacing_.cwiseProduct(lattice_.cellsOf(leaf).min.cast<double>()).cast<float>();
    }
    Eigen::Vector3f step() const noexcept { return step_.cast<float>(); }
    Eigen::Vector3i leafOriginSteps(LeafId leaf) const noexcept {
        return lattice_.cellsOf(leaf).min * steps_per_cell_;
    }

    Eigen::Vector3i stepsOf(LeafId leaf, const PackedVertex& vertex) const noexcept {
        return leafOriginSteps(leaf) + Eigen::Vector3i(vertex.x, vertex.y, vertex.z);
    }
    // The place is in V and m, and exactly the same for the same steps, whichever leaf they come from.
    Eigen::Vector3d position(const Eigen::Vector3i& steps) const noexcept {
        return step_.cwiseProduct(steps.cast<double>());
    }

  private:
    static constexpr int kMaxLocalSteps = 65535;  // PackedVertex coordinates are 16 bit
    // A vertex keeps one step away from both ends of its edge, and needs one left.
    static constexpr int kMinStepsPerCell = 3;

    const LeafLattice& lattice_;
    int steps_per_cell_;
    Eigen::Vector3d spacing_;  // m
    Eigen::Vector3d step_;     // m
};

}  // namespace bonemill
