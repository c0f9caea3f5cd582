#include "render_client/look/model/mesh_difference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace bonemill {
namespace {

struct Corner {
    PackedVertex vertex;
    uint8_t material;
};
using Triangle = std::array<Corner, 3>;

std::pair<uint64_t, uint8_t> keyOf(const Corner& corner) {
    return {std::bit_cast<uint64_t>(corner.vertex), corner.material};
}

Corner cornerOf(const NodeMesh& mesh, uint32_t index) {
    return {mesh.vertices[index], mesh.materials.empty() ? uint8_t(0) : mesh.materials[index]};
}

bool isBefore(const Triangle& a, const Triangle& b) {
    for (size_t i = 0; i < 3; ++i)
        if (keyOf(a[i]) != keyOf(b[i])) return keyOf(a[i]) < keyOf(b[i]);
    return false;
}

// Each triangle begins with its smallest corner: the same one is the same, however it was numbered.
std::vector<Triangle> sortedTriangles(const NodeMesh& mesh) {
    std::vector<Triangle> triangles(mesh.indices.size() / 3);
    for (size_t n = 0; n < triangles.size(); ++n) {
        Triangle& t = triangles[n];
        for (size_t i = 0; i < 3; ++i) t[i] = cornerOf(mesh, mesh.indices[3 * n + i]);
        const auto first =
            std::min_element(t.begin(), t.end(), [](auto& a, auto& b) { return keyOf(a) < keyOf(b); });
        std::rotate(t.begin(), first, t.end());
    }
    std::sort(triangles.begin(), triangles.end(), isBefore);
    return triangles;
}

}  // namespace

Eigen::AlignedBox3f boxOf(const NodeMesh& mesh) {
    Eigen::AlignedBox3f box;
    for (const PackedVertex& vertex : mesh.vertices) box.extend(positionOf(mesh, vertex));
    return box;
}

Eigen::AlignedBox3f differenceBox(const NodeMesh& before, const NodeMesh& after) {
    if (before.origin != after.origin || before.step != after.step) return boxOf(before).merged(boxOf(after));
    const std::vector<Triangle> old_ones = sortedTriangles(before), new_ones = sortedTriangles(after);
    std::vector<Triangle> different;
    std::set_symmetric_difference(old_ones.begin(), old_ones.end(), new_ones.begin(), new_ones.end(),
                                  std::back_inserter(different), isBefore);
    Eigen::AlignedBox3f box;
    for (const Triangle& triangle : different)
        for (const Corner& corner : triangle) box.extend(positionOf(after, corner.vertex));
    return box;
}

}  // namespace bonemill
