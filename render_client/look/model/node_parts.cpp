#include "render_client/look/model/node_parts.h"

#include <algorithm>
#include <array>

#include "render_client/look/model/mesh_difference.h"

namespace bonemill {
namespace {

constexpr int kCells = 4;  // of the grid, along each axis of the node
constexpr size_t kAllCells = size_t(kCells) * kCells * kCells;

class PlaceGrid {
  public:
    explicit PlaceGrid(const NodeMesh& mesh) : mesh_(mesh) {
        for (const PackedVertex& v : mesh.vertices) box_.extend(Eigen::Vector3i(v.x, v.y, v.z));
    }
    size_t cellOf(uint32_t vertex) const {
        const PackedVertex& v = mesh_.vertices[vertex];
        const Eigen::Array3i at = Eigen::Array3i(v.x, v.y, v.z) - box_.min().array();
        const Eigen::Array3i cell = at * kCells / (box_.sizes().array() + 1);
        return (size_t(cell.z()) * kCells + size_t(cell.y())) * kCells + size_t(cell.x());
    }

  private:
    const NodeMesh& mesh_;
    Eigen::AlignedBox3i box_;  // in steps
};

}  // namespace

SortedTriangles sortedByPlace(const NodeMesh& mesh) {
    const PlaceGrid grid(mesh);
    const size_t count = mesh.indices.size() / 3;
    std::vector<uint8_t> cells(count);
    std::array<uint32_t, kAllCells + 1> first{};
    for (size_t t = 0; t < count; ++t) {
        cells[t] = uint8_t(grid.cellOf(mesh.indices[3 * t]));
        first[cells[t] + size_t(1)] += 3;
    }
    for (size_t cell = 0; cell < kAllCells; ++cell) first[cell + 1] += first[cell];
    SortedTriangles sorted;
    sorted.indices.resize(3 * count);
    std::array<Eigen::AlignedBox3f, kAllCells> boxes;
    auto place = first;
    for (size_t t = 0; t < count; ++t)
        for (size_t i = 3 * t; i < 3 * t + 3; ++i) {
            sorted.indices[place[cells[t]]++] = mesh.indices[i];
            boxes[cells[t]].extend(positionOf(mesh, mesh.vertices[mesh.indices[i]]));
        }
    for (size_t cell = 0; cell < kAllCells; ++cell)
        if (first[cell + 1] > first[cell])
            sorted.parts.push_back({first[cell], first[cell + 1] - first[cell], boxes[cell]});
    return sorted;
}

}  // namespace bonemill
