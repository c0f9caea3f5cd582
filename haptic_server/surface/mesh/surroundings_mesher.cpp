#include "haptic_server/surface/mesh/surroundings_mesher.h"

#include <meshoptimizer.h>

#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "haptic_server/surface/mesh/surroundings_joint.h"

namespace bonemill {
namespace {

constexpr int kLeafCells =
    32;  // large, for few things to draw; MeshGrid::kStreamedStepsPerCell of them fit 16 bits

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

uint32_t scanLeafCount(const VolumeGeometry& scan) {
    return uint32_t(((scan.dims.array() + 1 + kLeafCells - 1) / kLeafCells).prod());
}

// The scan's cells around the joint; false: the sink wants no more.
bool meshScan(const Surroundings& surroundings, const IndexBox& joint, uint32_t first_leaf, ScanShade* shade,
              const SurroundingsSink& sink) {
    const VoxelVolume& volume = surroundings.volume;
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(kLeafCells));
    LeafMesher mesher(volume, lattice, MeshGrid::kStreamedStepsPerCell, {nullptr, shade});
    mesher.leaveOut(joint);
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, volume.iso())) continue;
        std::optional<NodeMesh> mesh = mesher.mesh(leaf);
        if (!mesh || mesh->isEmpty()) continue;
        mesh->leaf += first_leaf;
        mesh->origin = (surroundings.X_VS * Eigen::Vector3d(mesh->origin.cast<double>())).cast<float>();
        simplify(*mesh, kSurroundingsMoved * volume.spacing().minCoeff());
        if (!sink(std::move(*mesh))) return false;
    }
    return true;
}

}  // namespace

uint32_t surroundingsLeafCount(const Surroundings& surroundings) {
    return scanLeafCount(surroundings.volume.geometry()) +
           SurroundingsJoint(surroundings, nullptr).partCount();
}

void meshSurroundings(const Surroundings& surroundings, uint32_t first_leaf, const ShadeScale& shades,
                      const SurroundingsSink& sink) {
    const VoxelVolume& volume = surroundings.volume;
    std::optional<ScanShade> shade;
    if (shades.count > 0) shade.emplace(shades, volume.geometry(), Pose{}, volume.iso(), densitiesOf(volume));
    const SurroundingsJoint joint(surroundings, shade ? &*shade : nullptr);
    if (!meshScan(surroundings, joint.cells(), first_leaf, shade ? &*shade : nullptr, sink)) return;
    const uint32_t first_part = first_leaf + scanLeafCount(volume.geometry());
    for (uint32_t part = 0; part < joint.partCount(); ++part) {
        NodeMesh mesh = joint.mesh(part);
        mesh.leaf = first_part + part;
        if (!mesh.isEmpty() && !sink(std::move(mesh))) return;
    }
}

}  // namespace bonemill
