#include "haptic_server/surface/mesh/surroundings_mesher.h"

#include <meshoptimizer.h>

#include "haptic_server/surface/mesh/leaf_mesher.h"

namespace bonemill {
namespace {

constexpr int kLeafCells =
    32;  // large, for few things to draw; MeshGrid::kStreamedStepsPerCell of them fit 16 bits

void leaveOutInside(NodeMesh& mesh, const Eigen::AlignedBox3d& box) {
    std::vector<bool> is_inside;
    for (const PackedVertex& v : mesh.vertices) {
        const Eigen::Vector3f at =
            mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(float(v.x), float(v.y), float(v.z)));
        is_inside.push_back(box.contains(at.cast<double>()));
    }
    std::vector<uint32_t> kept;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t* const corner = &mesh.indices[i];
        if (is_inside[corner[0]] && is_inside[corner[1]] && is_inside[corner[2]]) continue;
        kept.insert(kept.end(), corner, corner + 3);
    }
    mesh.indices = std::move(kept);
}

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

}  // namespace

uint32_t surroundingsLeafCount(const VolumeGeometry& scan) {
    return uint32_t(((scan.dims.array() + 1 + kLeafCells - 1) / kLeafCells).prod());
}

void meshSurroundings(const Surroundings& surroundings, uint32_t first_leaf, const ShadeScale& shades,
                      const SurroundingsSink& sink) {
    const VoxelVolume& volume = surroundings.volume;
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(kLeafCells));
    std::optional<ScanShade> shade;
    if (shades.count > 0) shade.emplace(shades, volume.geometry(), Pose{}, volume.iso(), densitiesOf(volume));
    LeafMesher mesher(volume, lattice, MeshGrid::kStreamedStepsPerCell, {nullptr, shade ? &*shade : nullptr});
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        if (!lattice.mayHoldSurface(leaf, volume.iso())) continue;
        std::optional<NodeMesh> mesh = mesher.mesh(leaf);
        if (!mesh || mesh->isEmpty()) continue;
        mesh->leaf += first_leaf;
        mesh->origin = (surroundings.X_VS * Eigen::Vector3d(mesh->origin.cast<double>())).cast<float>();
        leaveOutInside(*mesh, surroundings.milled);
        if (mesh->isEmpty()) continue;
        simplify(*mesh, kSurroundingsMoved * volume.spacing().minCoeff());
        if (!sink(std::move(*mesh))) return;
    }
}

}  // namespace bonemill
