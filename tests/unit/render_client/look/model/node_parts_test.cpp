#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "render_client/look/model/node_store.h"

namespace bonemill {
namespace {

using Corners = std::array<uint32_t, 3>;

// A wavy sheet of n × n squares.
NodeMesh sheet(uint32_t n) {
    NodeMesh mesh;
    mesh.step = Eigen::Vector3f(1e-6f, 1e-6f, 2e-6f);
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            mesh.vertices.push_back({uint16_t(100 * x), uint16_t(100 * y), uint16_t(x * y % 97), 0, 127});
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, b, c + 1, c});
        }
    return mesh;
}

std::vector<Corners> trianglesOf(const std::vector<uint32_t>& indices) {
    std::vector<Corners> triangles;
    for (size_t i = 0; i < indices.size(); i += 3)
        triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

TEST(NodeParts, HoldEveryTriangleOnceInBoxesAroundThem) {
    const NodeMesh mesh = sheet(24);
    const SortedTriangles sorted = sortedByPlace(mesh);
    EXPECT_EQ(trianglesOf(sorted.indices), trianglesOf(mesh.indices));
    uint32_t next = 0;
    for (const NodePart& part : sorted.parts) {
        EXPECT_EQ(part.first, next);
        EXPECT_GT(part.count, 0u);
        next = part.first + part.count;
        for (uint32_t i = part.first; i < next; ++i)
            EXPECT_TRUE(part.box.contains(positionOf(mesh, mesh.vertices[sorted.indices[i]])));
    }
    EXPECT_EQ(next, mesh.indices.size());
}

TEST(NodeParts, AreSmallerThanTheNode) {
    const NodeMesh mesh = sheet(24);
    const SortedTriangles sorted = sortedByPlace(mesh);
    EXPECT_GE(sorted.parts.size(), 16u);
    for (const NodePart& part : sorted.parts)
        EXPECT_LT(part.box.sizes().x(), 0.35f * boxOf(mesh).sizes().x());
}

TEST(NodeParts, OfOneTriangleIsOne) {
    NodeMesh mesh = sheet(1);
    mesh.indices.resize(3);
    EXPECT_EQ(sortedByPlace(mesh).parts.size(), 1u);
}

}  // namespace
}  // namespace bonemill
