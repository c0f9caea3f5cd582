#include "haptic_server/surface/mesh/welded_mesh.h"

#include <algorithm>

namespace bonemill {
namespace {

constexpr float kShortestSum = 1e-3f;  // of unit normals that cancel each other: the vertex has no direction

bool isBefore(const Eigen::Vector3i& a, const Eigen::Vector3i& b) noexcept {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

std::vector<Eigen::Vector3i> distinctPoints(std::span<const NodeMesh> meshes, const MeshGrid& grid) {
    std::vector<Eigen::Vector3i> points;
    for (const NodeMesh& mesh : meshes)
        for (const PackedVertex& vertex : mesh.vertices) points.push_back(grid.stepsOf(mesh.leaf, vertex));
    std::sort(points.begin(), points.end(), isBefore);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

}  // namespace

WeldedMesh weld(std::span<const NodeMesh> meshes, const MeshGrid& grid) {
    WeldedMesh welded;
    welded.vertices = distinctPoints(meshes, grid);
    welded.normals.assign(welded.vertices.size(), Eigen::Vector3f::Zero());
    std::vector<uint32_t> number;
    for (const NodeMesh& mesh : meshes) {
        number.clear();
        for (const PackedVertex& vertex : mesh.vertices) {
            const auto found = std::lower_bound(welded.vertices.begin(), welded.vertices.end(),
                                                grid.stepsOf(mesh.leaf, vertex), isBefore);
            number.push_back(uint32_t(found - welded.vertices.begin()));
            welded.normals[number.back()] += decodeNormal(vertex.octahedral_u, vertex.octahedral_v);
        }
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            welded.triangles.push_back(
                {number[mesh.indices[i]], number[mesh.indices[i + 1]], number[mesh.indices[i + 2]]});
    }
    for (Eigen::Vector3f& normal : welded.normals)
        normal = normal.norm() > kShortestSum ? normal.normalized() : Eigen::Vector3f::UnitZ();
    return welded;
}

}  // namespace bonemill
