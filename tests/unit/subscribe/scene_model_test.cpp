#include "render_client/subscribe/scene_model.h"

#include <gtest/gtest.h>

#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

constexpr uint64_t kEpoch = 1000;
constexpr uint64_t kWriter = 1;
const SceneModel::Clock::time_point kNow{};

// The revision stands for the content.
void apply(SceneModel& model, uint32_t leaf, uint32_t revision, const NodeTag& tag, uint64_t writer = kWriter,
           SceneModel::Clock::time_point now = kNow) {
    model.applyNode({syntheticNode(leaf, revision), tag, revision}, writer, now);
}

TEST(SceneModel, HandsOutEachChangeOnce) {
    SceneModel model;
    apply(model, 5, 2, {.epoch = kEpoch}, kWriter);
    const auto changes = model.takeChanges(kNow);
    ASSERT_EQ(changes.nodes.size(), 1u);
    EXPECT_EQ(changes.nodes[0].mesh.leaf, 5u);
    EXPECT_FALSE(changes.is_cleared);
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
}

TEST(SceneModel, AppliesIdempotently) {
    SceneModel model;
    apply(model, 5, 4, {.epoch = kEpoch}, kWriter);
    const NodeDigest digest = model.digest();
    model.takeChanges(kNow);
    apply(model, 5, 4, {.epoch = kEpoch}, kWriter);
    apply(model, 5, 2, {.epoch = kEpoch}, kWriter);
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    EXPECT_EQ(model.digest(), digest);
}

TEST(SceneModel, AcceptsRevisionZero) {
    SceneModel model;
    apply(model, 5, 0, {.epoch = kEpoch}, kWriter);
    EXPECT_EQ(model.digest().count(), 1u);
}

TEST(SceneModel, DigestIsThatOfTheNewestRevisions) {
    SceneModel model;
    NodeDigest expected;
    for (uint32_t leaf = 0; leaf < 50; ++leaf) {
        for (uint32_t revision = 0; revision <= leaf % 7; ++revision) {
            apply(model, leaf, revision, {.epoch = kEpoch}, kWriter);
        }
        expected.add(leaf, leaf % 7);
    }
    EXPECT_EQ(model.digest(), expected);
}

TEST(SceneModel, RemovalIsAnEmptyMeshAndCountsOnce) {
    SceneModel model;
    apply(model, 5, 2, {.epoch = kEpoch}, kWriter);
    model.takeChanges(kNow);
    model.removeNode(5, kWriter);
    model.removeNode(5, kWriter);
    model.removeNode(6, kWriter);
    const auto changes = model.takeChanges(kNow);
    ASSERT_EQ(changes.nodes.size(), 1u);
    EXPECT_EQ(changes.nodes[0].mesh.leaf, 5u);
    EXPECT_TRUE(changes.nodes[0].mesh.isEmpty());
    EXPECT_EQ(model.digest(), NodeDigest());
}

TEST(SceneModel, RemovedNodeCanComeBack) {
    SceneModel model;
    apply(model, 5, 2, {.epoch = kEpoch}, kWriter);
    model.removeNode(5, kWriter);
    apply(model, 5, 6, {.epoch = kEpoch}, kWriter);
    EXPECT_EQ(model.digest().count(), 1u);
    EXPECT_FALSE(model.takeChanges(kNow).nodes.back().mesh.isEmpty());
}

TEST(SceneModel, NewerEpochReplacesTheModelEvenWithLowerRevisions) {
    SceneModel model;
    apply(model, 5, 20, {.epoch = kEpoch}, kWriter);
    apply(model, 6, 20, {.epoch = kEpoch}, kWriter);
    apply(model, 5, 0, {.epoch = kEpoch + 1}, kWriter + 1);
    NodeDigest expected;
    expected.add(5, 0);
    EXPECT_EQ(model.digest(), expected);
    const auto changes = model.takeChanges(kNow);
    EXPECT_TRUE(changes.is_cleared);
    ASSERT_EQ(changes.nodes.size(), 1u) << "nothing of the old run may follow the clearing";
    EXPECT_EQ(changes.nodes[0].mesh.revision, 0u);
}

TEST(SceneModel, OlderEpochChangesNothing) {
    SceneModel model;
    apply(model, 5, 0, {.epoch = kEpoch}, kWriter);
    const NodeDigest digest = model.digest();
    EXPECT_FALSE(model.enterEpoch(kEpoch - 1));
    apply(model, 5, 20, {.epoch = kEpoch - 1}, kWriter + 1);
    model.removeNode(5, kWriter + 1);
    EXPECT_EQ(model.digest(), digest);
    EXPECT_EQ(model.epoch(), kEpoch);
}

TEST(SceneModel, RemovalByAWriterNotSeenBeforeCounts) {
    SceneModel model;
    apply(model, 5, 2, {.epoch = kEpoch}, kWriter);
    model.removeNode(5, kWriter + 1);  // the same server, matched anew after an interruption
    EXPECT_EQ(model.digest().count(), 0u);
}

std::vector<uint32_t> leavesOf(const SceneModel::Changes& changes) {
    std::vector<uint32_t> leaves;
    for (const SceneModel::Change& change : changes.nodes) leaves.push_back(change.mesh.leaf);
    return leaves;
}

TEST(SceneModel, ABatchComesOutWhole) {
    SceneModel model;
    const NodeTag batch{.epoch = kEpoch, .batch = 1, .batch_nodes = 3, .cut_stamp_ns = 77};
    apply(model, 1, 2, batch);
    apply(model, 2, 2, batch);
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    EXPECT_EQ(model.digest().count(), 0u) << "what is not shown does not count";
    apply(model, 3, 2, batch);
    const auto changes = model.takeChanges(kNow);
    EXPECT_EQ(leavesOf(changes), (std::vector<uint32_t>{1, 2, 3}));
    EXPECT_EQ(changes.nodes[0].cut_stamp_ns, 77);
    EXPECT_EQ(model.digest().count(), 3u);
}

// Node 2 of the older batch was overtaken by its newer version; shown without it, node 1 would leave a crack.
TEST(SceneModel, AnOvertakenBatchComesOutWithTheNextOne) {
    SceneModel model;
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    apply(model, 2, 4, {.epoch = kEpoch, .batch = 2, .batch_nodes = 2});
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    apply(model, 3, 4, {.epoch = kEpoch, .batch = 2, .batch_nodes = 2});
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{1, 2, 3}));
}

// DDS hands out node by node: one of an older batch may come after the first ones of a newer one.
TEST(SceneModel, AnOlderBatchWaitsForTheNewestToo) {
    SceneModel model;
    apply(model, 2, 4, {.epoch = kEpoch, .batch = 2, .batch_nodes = 2});
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    apply(model, 3, 4, {.epoch = kEpoch, .batch = 2, .batch_nodes = 2});
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{2, 1, 3}));
    apply(model, 4, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});  // again, after an interruption
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{4}));
}

// This holds however many batches follow each other, each cut short.
TEST(SceneModel, TheFirstThatWaitsStartsTheClock) {
    SceneModel model;
    for (int n = 1; n <= 6; ++n) {
        const auto now = kNow + (n - 1) * std::chrono::milliseconds(10);
        apply(model, uint32_t(n), 2, {.epoch = kEpoch, .batch = uint64_t(n), .batch_nodes = 2}, kWriter, now);
        EXPECT_TRUE(model.takeChanges(now).nodes.empty());
    }
    EXPECT_EQ(model.takeChanges(kNow + std::chrono::milliseconds(51)).nodes.size(), 6u);
}

TEST(SceneModel, NothingWaitsForALostNodeForLong) {
    SceneModel model;
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    EXPECT_TRUE(model.takeChanges(kNow + SceneModel::kLongestWait).nodes.empty());
    const auto late = kNow + SceneModel::kLongestWait + std::chrono::milliseconds(1);
    EXPECT_EQ(leavesOf(model.takeChanges(late)), (std::vector<uint32_t>{1}));
}

TEST(SceneModel, ARemovalDoesNotOvertakeWhatWaits) {
    SceneModel model;
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    model.removeNode(1, kWriter);
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    apply(model, 2, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{1, 1, 2}));
    EXPECT_EQ(model.digest().count(), 1u);
}

TEST(SceneModel, AnotherRunForgetsWhatWaits) {
    SceneModel model;
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 9, .batch_nodes = 2});
    apply(model, 2, 2, {.epoch = kEpoch + 1, .batch = 1, .batch_nodes = 1});
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{2}));
}

}  // namespace
}  // namespace bonemill
