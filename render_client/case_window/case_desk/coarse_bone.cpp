#include "render_client/case_window/case_desk/coarse_bone.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/surface/mesh/leaf_mesher.h"

namespace bonemill {
namespace {

constexpr int kLeafCells = 32;

// Voxels of the fine volume per coarse one, so that coarse cells are about cubes.
Eigen::Vector3i stepsOf(const VoxelVolume& volume, int most_cells) {
    const Eigen::Vector3d extent = volume.spacing().cwiseProduct(volume.dims().cast<double>());
    const double wanted = extent.maxCoeff() / most_cells;
    return (wanted * volume.spacing().cwiseInverse()).array().round().max(1.0).cast<int>();
}

// The mean of the block's corners and middle: thin walls stay longer than with one of them alone.
Density meanOf(const VoxelVolume& fine, const Eigen::Vector3i& low, const Eigen::Vector3i& steps) {
    const Eigen::Vector3i high = (low + steps).cwiseMin(fine.dims()).array() - 1;
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner)
        sum += fine.at(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                       corner & 4 ? high.z() : low.z());
    return Density(std::lround(sum / 8));
}

VoxelVolume coarseVolume(const VoxelVolume& fine, const Eigen::Vector3i& steps) {
    VolumeGeometry grid = fine.geometry();
    grid.dims = (fine.dims().array() + steps.array() - 1) / steps.array();
    grid.spacing = fine.spacing().cwiseProduct(steps.cast<double>());
    std::vector<Density> densities;
    densities.reserve(grid.voxelCount());
    for (int k = 0; k < grid.dims.z(); ++k)
        for (int j = 0; j < grid.dims.y(); ++j)
            for (int i = 0; i < grid.dims.x(); ++i)
                densities.push_back(meanOf(fine, steps.cwiseProduct(Eigen::Vector3i(i, j, k)), steps));
    VoxelVolume coarse(grid, fine.iso());
    const size_t row = size_t(grid.dims.x()), slice = row * size_t(grid.dims.y());
    coarse.fill(
        [&](int i, int j, int k) { return densities[size_t(i) + row * size_t(j) + slice * size_t(k)]; });
    return coarse;
}

}  // namespace

std::vector<NodeMesh> coarseBone(const VoxelVolume& volume, int most_cells) {
    const Eigen::Vector3i steps = stepsOf(volume, most_cells);
    const VoxelVolume coarse = coarseVolume(volume, steps);
    const Eigen::Vector3d first =
        volume.spacing().cwiseProduct((steps.cast<double>().array() - 1).matrix()) / 2;
    const LeafLattice lattice(coarse, Eigen::Vector3i::Constant(kLeafCells));
    LeafMesher mesher(coarse, lattice, MeshGrid::kStreamedStepsPerCell);
    std::vector<NodeMesh> meshes;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, coarse.iso())) continue;
        std::optional<NodeMesh> mesh = mesher.mesh(leaf);
        if (!mesh || mesh->isEmpty()) continue;
        mesh->origin += first.cast<float>();
        meshes.push_back(std::move(*mesh));
    }
    return meshes;
}

}  // namespace bonemill
