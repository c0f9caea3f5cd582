#include "haptic_server/surface/mesh/surroundings_mesher.h"

#include <meshoptimizer.h>

#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "haptic_server/surface/mesh/surroundings_joint.h"

namespace bonemill {
namespace {

void keepUsed(NodeMesh& mesh) {
    const size_t count = mesh.vertices.size();
    std::vector<unsigned int> place(count);
    const size_t used =
        meshopt_optimizeVertexFetchRemap(place.data(), mesh.indices.data(), mesh.indices.size(), count);
    meshopt_remapIndexBuffer(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(), place.data());
    meshopt_remapVertexBuffer(mesh.vertices.data(), mesh.vertices.data(), count, sizeof(PackedVertex),
                              place.data());
    mesh.vertices.resize(used);
    if (mesh.materials.empty()) return;
    meshopt_remapVertexBuffer(mesh.materials.data(), mesh.materials.data(), count, 1, place.data());
    mesh.materials.resize(used);
}

void simplify(NodeMesh& mesh, double most_moved) {
    std::vector<Eigen::Vector3f> positions;
    for (const PackedVertex& v : mesh.vertices)
        positions.push_back(mesh.step.cwiseProduct(Eigen::Vector3f(float(v.x), float(v.y), float(v.z))));
    const float* const coordinates = positions[0].data();
    constexpr size_t kStride = sizeof(Eigen::Vector3f);
    const float scale = meshopt_simplifyScale(coordinates, positions.size(), kStride);
    std::vector<uint32_t> fewer(mesh.indices.size());
    fewer.resize(meshopt_simplify(fewer.data(), mesh.indices.data(), mesh.indices.size(), coordinates,
                                  positions.size(), kStride, 0, float(most_moved) / scale,
                                  meshopt_SimplifyLockBorder));
    if (!fewer.empty()) mesh.indices = std::move(fewer);
    keepUsed(mesh);
}

uint32_t scanLeafCount(const VolumeGeometry& scan, const RimGrid& grid) {
    return uint32_t(((scan.dims.array() + 1 + grid.partCells() - 1) / grid.partCells()).prod());
}

void moveTo(const RimGrid& grid, const Eigen::Vector3i& first_cell, NodeMesh& mesh) {
    const Eigen::Vector3i first_scan_step = first_cell * RimGrid::kStepsPerCell;
    const Eigen::Vector3i first_step = grid.stepsAt(grid.placeInScan(first_scan_step));
    grid.begin(mesh, first_step);
    for (PackedVertex& v : mesh.vertices) {
        const Eigen::Vector3i scan_steps = first_scan_step + Eigen::Vector3i(v.x, v.y, v.z);
        const Eigen::Vector3i steps = grid.stepsAt(grid.placeInScan(scan_steps)) - first_step;
        v.x = uint16_t(steps.x());
        v.y = uint16_t(steps.y());
        v.z = uint16_t(steps.z());
    }
}

// The scan's cells around the joint; false: the sink wants no more.
bool meshScan(const Surroundings& surroundings, const SurroundingsJoint& joint, uint32_t first_leaf,
              ScanShade* shade, const SurroundingsSink& sink) {
    const VoxelVolume& volume = surroundings.volume;
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(joint.grid().partCells()));
    LeafMesher mesher(volume, lattice, MeshGrid::kStreamedStepsPerCell, {nullptr, shade});
    mesher.leaveOut(joint.cells());
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, volume.iso())) continue;
        std::optional<NodeMesh> mesh = mesher.mesh(leaf);
        if (!mesh || mesh->isEmpty()) continue;
        mesh->leaf += first_leaf;
        moveTo(joint.grid(), lattice.cellsOf(leaf).min, *mesh);
        simplify(*mesh, kSurroundingsMoved * volume.spacing().minCoeff());
        if (!sink(std::move(*mesh))) return false;
    }
    return true;
}

}  // namespace

uint32_t surroundingsLeafCount(const Surroundings& surroundings) {
    const SurroundingsJoint joint(surroundings, nullptr);
    return scanLeafCount(surroundings.volume.geometry(), joint.grid()) + joint.partCount();
}

void meshSurroundings(const Surroundings& surroundings, uint32_t first_leaf, const ShadeScale& shades,
                      const SurroundingsSink& sink) {
    const VoxelVolume& volume = surroundings.volume;
    std::optional<ScanShade> shade;
    if (shades.count > 0) shade.emplace(shades, volume.geometry(), Pose{}, volume.iso(), densitiesOf(volume));
    const SurroundingsJoint joint(surroundings, shade ? &*shade : nullptr);
    if (!meshScan(surroundings, joint, first_leaf, shade ? &*shade : nullptr, sink)) return;
    const uint32_t first_part = first_leaf + scanLeafCount(volume.geometry(), joint.grid());
    for (uint32_t part = 0; part < joint.partCount(); ++part) {
        NodeMesh mesh = joint.mesh(part);
        mesh.leaf = first_part + part;
        if (!mesh.isEmpty() && !sink(std::move(mesh))) return;
    }
}

}  // namespace bonemill
