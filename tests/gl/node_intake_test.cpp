#include "render_client/look/render_scene/node_intake.h"

#include <gtest/gtest.h>

#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/gl/milled_scene.h"

namespace bonemill {
namespace {

class NodeIntakeTest : public testing::Test {
  protected:
    // One triangle has a last vertex that is not there.
    static NodeMesh broken(NodeMesh mesh) {
        mesh.indices.back() = uint32_t(mesh.vertices.size());
        return mesh;
    }

    const std::vector<NodeMesh>& nodes_ = test::milledBlock();
    OsmesaContext context_{64, 48};
    RenderScene scene_{context_.gl()};
    NodeIntake intake_{scene_};
};

TEST_F(NodeIntakeTest, OneThatCannotBeDrawnIsCountedAndTheOthersArrive) {
    EXPECT_FALSE(intake_.set(broken(nodes_[0])));
    for (size_t i = 1; i < nodes_.size(); ++i) EXPECT_TRUE(intake_.set(nodes_[i])) << i;
    EXPECT_EQ(scene_.nodeCount(), nodes_.size() - 1);
    EXPECT_EQ(intake_.refusedCount(), 1u);
}

TEST_F(NodeIntakeTest, ALeafStaysAsItWasUntilItsNextMesh) {
    EXPECT_TRUE(intake_.set(nodes_[0]));
    const size_t triangles = scene_.triangleCount();
    NodeMesh mismatched = nodes_[0];
    mismatched.materials.assign(mismatched.vertices.size() + 1, 1);
    EXPECT_FALSE(intake_.set(mismatched));
    EXPECT_FALSE(intake_.set(broken(nodes_[0])));
    EXPECT_EQ(scene_.triangleCount(), triangles);
    EXPECT_EQ(intake_.refusedCount(), 1u) << "one leaf, however often";
    EXPECT_TRUE(intake_.set(nodes_[0]));
    EXPECT_EQ(intake_.refusedCount(), 0u);
}

TEST_F(NodeIntakeTest, WhatCannotBeDrawnDoesNotReachTheEffectsEither) {
    topics::SceneInfo info = test::milledInfo();
    test::listAllEffects(info);
    scene_.setSceneInfo(info);
    NodeMesh mismatched = nodes_[0];
    mismatched.materials.assign(1, 1);  // the effects look materials up by vertex
    EXPECT_FALSE(intake_.set(mismatched));
    scene_.setToolState(test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1));
    for (const NodeMesh& node : nodes_) intake_.set(node);
    scene_.advance(0.1);
    scene_.draw(64, 48, 1);
    EXPECT_EQ(scene_.nodeCount(), nodes_.size());
}

TEST_F(NodeIntakeTest, AnotherRunOfTheServerBeginsAnew) {
    intake_.set(nodes_[1]);
    intake_.set(broken(nodes_[0]));
    scene_.setToolState(test::makeToolState(test::toolInCavity(), test::toolInCavity(), 1));
    intake_.clear();
    EXPECT_EQ(scene_.nodeCount(), 0u);
    EXPECT_FALSE(scene_.devicePose()) << "figures of the run before are none of this one's";
    EXPECT_EQ(intake_.refusedCount(), 0u);
}

}  // namespace
}  // namespace bonemill
