#include "haptic_server/surface/mesh/mesh_grid.h"

#include <algorithm>
#include <stdexcept>

namespace bonemill {
namespace {

constexpr int kMaxLocalSteps = 65535;  // PackedVertex coordinates are 16 bit
constexpr int kMinStepsPerCell =
    3;  // a vertex keeps one step away from both ends of its edge, and needs one left

}  // namespace

MeshGrid::MeshGrid(const VoxelVolume& volume, const LeafLattice& lattice, int most_steps_per_cell)
    : lattice_(lattice),
      steps_per_cell_(std::min(most_steps_per_cell, kMaxLocalSteps / lattice.leafCells().maxCoeff())),
      spacing_(volume.spacing()),
      step_(spacing_ / steps_per_cell_) {
    if (steps_per_cell_ < kMinStepsPerCell) throw std::invalid_argument("octree leaf too large to mesh");
}

Eigen::Vector3f MeshGrid::leafOrigin(LeafId leaf) const noexcept {
    return spacing_.cwiseProduct(lattice_.cellsOf(leaf).min.cast<double>()).cast<float>();
}

}  // namespace bonemill
