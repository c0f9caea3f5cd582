#include <gtest/gtest.h>

#include <algorithm>

#include "render_client/look/model/node_store.h"

namespace bonemill {
namespace {

// Makes a strip of squares along x, one step of 1 mm each.
NodeMesh strip(int squares) {
    NodeMesh mesh;
    mesh.origin = {0.1f, 0, 0};
    mesh.step.setConstant(1e-3f);
    for (int i = 0; i <= squares; ++i)
        for (const uint16_t y : {0, 1}) mesh.vertices.push_back({uint16_t(i), y, 5, 0, 127});
    for (uint32_t i = 0; i < uint32_t(squares); ++i)
        for (const uint32_t k : {0, 2, 1, 1, 2, 3}) mesh.indices.push_back(2 * i + k);
    return mesh;
}

TEST(MeshDifference, IsEmptyForTheSameSurfaceInAnotherOrder) {
    NodeMesh turned = strip(6);
    std::rotate(turned.indices.begin(), turned.indices.begin() + 3, turned.indices.end());
    std::rotate(turned.indices.begin(), turned.indices.begin() + 1, turned.indices.begin() + 3);
    EXPECT_TRUE(differenceBox(strip(6), turned).isEmpty());
}

TEST(MeshDifference, IsAroundTheTrianglesThatChanged) {
    NodeMesh moved = strip(6);
    moved.vertices[6].z = 9;  // at x = 3: three triangles meet there
    const Eigen::AlignedBox3f box = differenceBox(strip(6), moved);
    EXPECT_TRUE(box.min().isApprox(Eigen::Vector3f(0.102f, 0, 0.005f), 1e-5f)) << box.min().transpose();
    EXPECT_TRUE(box.max().isApprox(Eigen::Vector3f(0.104f, 0.001f, 0.009f), 1e-5f)) << box.max().transpose();
    EXPECT_TRUE(box.isApprox(differenceBox(moved, strip(6))));
}

TEST(MeshDifference, SeesNormalsWindingAndLossToo) {
    NodeMesh other = strip(6);
    other.vertices[0].octahedral_u = 3;
    EXPECT_FALSE(differenceBox(strip(6), other).isEmpty());
    other = strip(6);
    std::swap(other.indices[0], other.indices[1]);
    EXPECT_FALSE(differenceBox(strip(6), other).isEmpty());
    const Eigen::AlignedBox3f lost = differenceBox(strip(6), strip(4));
    EXPECT_NEAR(lost.min().x(), 0.104f, 1e-6f);
    EXPECT_NEAR(lost.max().x(), 0.106f, 1e-6f);
}

TEST(MeshDifference, SeesMaterials) {
    NodeMesh coloured = strip(6);
    coloured.materials.assign(coloured.vertices.size(), 0);
    EXPECT_TRUE(differenceBox(strip(6), coloured).isEmpty()) << "none is none";
    coloured.materials[12] = 3;
    const Eigen::AlignedBox3f box = differenceBox(strip(6), coloured);
    EXPECT_NEAR(box.min().x(), 0.105f, 1e-6f);
    EXPECT_NEAR(box.max().x(), 0.106f, 1e-6f);
}

TEST(MeshDifference, IsAroundBothWhenTheGridIsAnother) {
    NodeMesh shifted = strip(2);
    shifted.origin.x() = 0.2f;
    const Eigen::AlignedBox3f box = differenceBox(strip(2), shifted);
    EXPECT_NEAR(box.min().x(), 0.1f, 1e-6f);
    EXPECT_NEAR(box.max().x(), 0.202f, 1e-6f);
}

}  // namespace
}  // namespace bonemill
