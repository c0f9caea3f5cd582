#include "render_client/subscribe/scene_model.h"

#include <gtest/gtest.h>

#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

constexpr uint64_t kEpoch = 1000;
constexpr uint64_t kWriter = 1;

TEST(SceneModel, HandsOutEachChangeOnce) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 2), kEpoch, kWriter);
    const auto changes = model.takeChanges();
    ASSERT_EQ(changes.nodes.size(), 1u);
    EXPECT_EQ(changes.nodes[0].leaf, 5u);
    EXPECT_FALSE(changes.is_cleared);
    EXPECT_TRUE(model.takeChanges().nodes.empty());
}

TEST(SceneModel, AppliesIdempotently) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 4), kEpoch, kWriter);
    const NodeDigest digest = model.digest();
    model.takeChanges();
    model.applyNode(syntheticNode(5, 4), kEpoch, kWriter);
    model.applyNode(syntheticNode(5, 2), kEpoch, kWriter);
    EXPECT_TRUE(model.takeChanges().nodes.empty());
    EXPECT_EQ(model.digest(), digest);
}

TEST(SceneModel, AcceptsRevisionZero) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 0), kEpoch, kWriter);
    EXPECT_EQ(model.digest().count(), 1u);
}

TEST(SceneModel, DigestIsThatOfTheNewestRevisions) {
    SceneModel model;
    NodeDigest expected;
    for (uint32_t leaf = 0; leaf < 50; ++leaf) {
        for (uint32_t revision = 0; revision <= leaf % 7; ++revision) {
            model.applyNode(syntheticNode(leaf, revision), kEpoch, kWriter);
        }
        expected.add(leaf, leaf % 7);
    }
    EXPECT_EQ(model.digest(), expected);
}

TEST(SceneModel, RemovalIsAnEmptyMeshAndCountsOnce) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 2), kEpoch, kWriter);
    model.takeChanges();
    model.removeNode(5, kWriter);
    model.removeNode(5, kWriter);
    model.removeNode(6, kWriter);
    const auto changes = model.takeChanges();
    ASSERT_EQ(changes.nodes.size(), 1u);
    EXPECT_EQ(changes.nodes[0].leaf, 5u);
    EXPECT_TRUE(changes.nodes[0].isEmpty());
    EXPECT_EQ(model.digest(), NodeDigest());
}

TEST(SceneModel, RemovedNodeCanComeBack) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 2), kEpoch, kWriter);
    model.removeNode(5, kWriter);
    model.applyNode(syntheticNode(5, 6), kEpoch, kWriter);
    EXPECT_EQ(model.digest().count(), 1u);
    EXPECT_FALSE(model.takeChanges().nodes.back().isEmpty());
}

TEST(SceneModel, NewerEpochReplacesTheModelEvenWithLowerRevisions) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 20), kEpoch, kWriter);
    model.applyNode(syntheticNode(6, 20), kEpoch, kWriter);
    model.applyNode(syntheticNode(5, 0), kEpoch + 1, kWriter + 1);
    NodeDigest expected;
    expected.add(5, 0);
    EXPECT_EQ(model.digest(), expected);
    const auto changes = model.takeChanges();
    EXPECT_TRUE(changes.is_cleared);
    ASSERT_EQ(changes.nodes.size(), 1u) << "nothing of the old run may follow the clearing";
    EXPECT_EQ(changes.nodes[0].revision, 0u);
}

TEST(SceneModel, OlderEpochChangesNothing) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 0), kEpoch, kWriter);
    const NodeDigest digest = model.digest();
    EXPECT_FALSE(model.enterEpoch(kEpoch - 1));
    model.applyNode(syntheticNode(5, 20), kEpoch - 1, kWriter + 1);
    model.removeNode(5, kWriter + 1);
    EXPECT_EQ(model.digest(), digest);
    EXPECT_EQ(model.epoch(), kEpoch);
}

TEST(SceneModel, RemovalByAWriterNotSeenBeforeCounts) {
    SceneModel model;
    model.applyNode(syntheticNode(5, 2), kEpoch, kWriter);
    model.removeNode(5, kWriter + 1);  // the same server, matched anew after an interruption
    EXPECT_EQ(model.digest().count(), 0u);
}

}  // namespace
}  // namespace bonemill
