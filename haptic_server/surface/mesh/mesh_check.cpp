#include "haptic_server/surface/mesh/mesh_check.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "haptic_server/surface/mesh/welded_mesh.h"

namespace bonemill {
namespace {

struct Edge {
    uint32_t low, high;  // point numbers
    bool runs_up;        // the triangle goes from low to high
    auto operator<=>(const Edge&) const = default;
};

std::vector<Edge> sortedEdges(const WeldedMesh& mesh) {
    std::vector<Edge> edges;
    for (const auto& triangle : mesh.triangles)
        for (size_t corner = 0; corner < 3; ++corner) {
            const uint32_t from = triangle[corner], to = triangle[(corner + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), from < to});
        }
    std::sort(edges.begin(), edges.end());
    return edges;
}

void countEdges(const std::vector<Edge>& edges, MeshCheck& check) {
    for (size_t first = 0; first < edges.size();) {
        size_t end = first + 1;
        while (end < edges.size() && edges[end].low == edges[first].low &&
               edges[end].high == edges[first].high)
            ++end;
        if (end - first == 1) ++check.open_edges;
        if (end - first > 2) ++check.crowded_edges;
        if (end - first == 2 && edges[first].runs_up == edges[first + 1].runs_up) ++check.misoriented_edges;
        first = end;
    }
}

}  // namespace

double meshVolume(std::span<const NodeMesh> meshes, const MeshGrid& grid) {
    double six_volumes = 0;
    for (const NodeMesh& mesh : meshes) {
        const auto position = [&](uint32_t index) {
            return grid.position(grid.stepsOf(mesh.leaf, mesh.vertices[index]));
        };
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            six_volumes += position(mesh.indices[i])
                               .dot(position(mesh.indices[i + 1]).cross(position(mesh.indices[i + 2])));
    }
    return six_volumes / 6;
}

MeshCheck checkMesh(std::span<const NodeMesh> meshes, const MeshGrid& grid) {
    MeshCheck check;
    const WeldedMesh mesh = weld(meshes, grid);
    check.vertices = mesh.vertices.size();
    check.triangles = mesh.triangles.size();
    countEdges(sortedEdges(mesh), check);
    check.volume = meshVolume(meshes, grid);
    return check;
}

}  // namespace bonemill
