#include "render_client/peers/ros2_session/bone_markers.h"

#include <gtest/gtest.h>

#include "tests/support/node_meshes.h"

namespace bonemill::ros2 {
namespace {

constexpr int32_t kAdd = 0, kDelete = 2, kDeleteAll = 3;

struct Told {
    std::vector<int32_t> ids, actions;
    size_t parts = 0, largest = 0;
};

Told tellAll(BoneMarkers& bone) {
    Told told;
    while (bone.hasUntold()) {
        MarkerPart part;
        EXPECT_TRUE(bone.takePart(part, 5));
        const MarkerArray& message = part.message();
        for (uint32_t i = 0; i < message.markers._length; ++i) {
            told.ids.push_back(message.markers._buffer[i].id);
            told.actions.push_back(message.markers._buffer[i].action);
        }
        ++told.parts;
        told.largest = std::max(told.largest, part.bytes());
    }
    return told;
}

NodeMesh emptyMesh(uint32_t leaf) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    return mesh;
}

TEST(BoneMarkers, TellWhatHasChangedOnce) {
    BoneMarkers bone;
    EXPECT_EQ(tellAll(bone).actions, std::vector<int32_t>{kDeleteAll});
    bone.take(test::sheetMesh(3, 7));
    bone.take(test::sheetMesh(3, 4));
    EXPECT_EQ(tellAll(bone).ids, (std::vector<int32_t>{4, 7}));
    MarkerPart nothing;
    EXPECT_FALSE(bone.takePart(nothing, 5));
    bone.take(emptyMesh(7));
    const Told removed = tellAll(bone);
    EXPECT_EQ(removed.ids, std::vector<int32_t>{7});
    EXPECT_EQ(removed.actions, std::vector<int32_t>{kDelete});
    bone.tellAnew();
    EXPECT_EQ(tellAll(bone).ids, std::vector<int32_t>{4});
    bone.clear();
    EXPECT_EQ(tellAll(bone).actions, std::vector<int32_t>{kDeleteAll});
}

TEST(BoneMarkers, HaveTheCornersOfTheTrianglesInMetres) {
    const NodeMesh mesh = test::sheetMesh(2, 9);
    BoneMarkers bone;
    bone.take(NodeMesh(mesh));
    MarkerPart part;
    ASSERT_TRUE(bone.takePart(part, 1'500'000'000));
    ASSERT_EQ(part.message().markers._length, 2u) << "all is forgotten first";
    const Marker& marker = part.message().markers._buffer[1];
    EXPECT_EQ(marker.action, kAdd);
    EXPECT_EQ(marker.type, 11);
    EXPECT_EQ(marker.header.stamp.sec, 1);
    EXPECT_STREQ(marker.header.frame_id, "bonemill_volume");
    ASSERT_EQ(marker.points._length, mesh.indices.size());
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        const PackedVertex& v = mesh.vertices[mesh.indices[i]];
        EXPECT_NEAR(marker.points._buffer[i].x, double(mesh.origin.x()) + double(mesh.step.x()) * v.x, 1e-8);
        EXPECT_NEAR(marker.points._buffer[i].z, double(mesh.origin.z()) + double(mesh.step.z()) * v.z, 1e-8);
    }
}

TEST(BoneMarkers, GoInPartsThatAreBounded) {
    BoneMarkers bone;
    const size_t bytes_each = test::sheetMesh(40, 1).indices.size() * sizeof(Point);
    for (unsigned leaf = 1; leaf <= 30; ++leaf) bone.take(test::sheetMesh(40, leaf));
    const Told told = tellAll(bone);
    EXPECT_EQ(told.ids.size(), 31u);
    EXPECT_LE(told.largest, BoneMarkers::kPartBytes);
    EXPECT_GE(told.parts, 30 * bytes_each / BoneMarkers::kPartBytes);
    // One that is larger goes alone.
    bone.take(test::sheetMesh(120, 1)), bone.take(test::sheetMesh(120, 2));
    EXPECT_EQ(tellAll(bone).parts, 2u);
}

}  // namespace
}  // namespace bonemill::ros2
