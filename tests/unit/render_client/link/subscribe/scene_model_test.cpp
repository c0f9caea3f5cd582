#include "render_client/link/subscribe/scene_model.h"

#include <gtest/gtest.h>

#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

constexpr uint64_t kEpoch = 1000;
const SceneModel::Clock::time_point kNow{};

// The revision stands for the content.
void apply(SceneModel& model, uint32_t leaf, uint32_t revision, const NodeTag& tag,
           SceneModel::Clock::time_point now = kNow) {
    EXPECT_TRUE(model.applyNode({syntheticNode(leaf, revision), tag, revision}, now));
}

SceneModel begun() {
    SceneModel model;
    model.begin(kEpoch);
    return model;
}

TEST(SceneModel, HandsOutEachChangeOnce) {
    SceneModel model = begun();
    apply(model, 5, 2, {.epoch = kEpoch});
    const auto changes = model.takeChanges(kNow);
    ASSERT_EQ(changes.nodes.size(), 1u);
    EXPECT_EQ(changes.nodes[0].mesh.leaf, 5u);
    EXPECT_FALSE(changes.is_cleared);
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
}

TEST(SceneModel, AppliesIdempotently) {
    SceneModel model = begun();
    apply(model, 5, 4, {.epoch = kEpoch});
    const NodeDigest digest = model.digest();
    model.takeChanges(kNow);
    apply(model, 5, 4, {.epoch = kEpoch});
    apply(model, 5, 2, {.epoch = kEpoch});
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    EXPECT_EQ(model.digest(), digest);
}

TEST(SceneModel, HandsOutOfEachLeafTheNewestMeshWithItsOldestCut) {
    SceneModel model = begun();
    apply(model, 5, 2, {.epoch = kEpoch, .cut_stamp_ns = 100});
    apply(model, 6, 2, {.epoch = kEpoch, .cut_stamp_ns = 200});
    apply(model, 5, 4, {.epoch = kEpoch, .cut_stamp_ns = 300});
    model.removeNode(6);
    const auto changes = model.takeChanges(kNow);
    ASSERT_EQ(changes.nodes.size(), 2u);
    EXPECT_EQ(changes.nodes[0].mesh.revision, 4u);
    EXPECT_EQ(changes.nodes[0].cut_stamp_ns, 100);
    EXPECT_TRUE(changes.nodes[1].mesh.isEmpty());
    apply(model, 6, 8, {.epoch = kEpoch});
    EXPECT_EQ(model.takeChanges(kNow).nodes.size(), 1u) << "the next picture's are counted anew";
}

TEST(SceneModel, WaitsUntilABatchIsWhole) {
    SceneModel model = begun();
    EXPECT_FALSE(model.isWaiting());
    apply(model, 5, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    EXPECT_TRUE(model.isWaiting());
    apply(model, 6, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    EXPECT_FALSE(model.isWaiting());
}

TEST(SceneModel, AcceptsRevisionZero) {
    SceneModel model = begun();
    apply(model, 5, 0, {.epoch = kEpoch});
    EXPECT_EQ(model.digest().count(), 1u);
}

TEST(SceneModel, DigestIsThatOfTheNewestRevisions) {
    SceneModel model = begun();
    NodeDigest expected;
    for (uint32_t leaf = 0; leaf < 50; ++leaf) {
        for (uint32_t revision = 0; revision <= leaf % 7; ++revision) {
            apply(model, leaf, revision, {.epoch = kEpoch});
        }
        expected.add(leaf, leaf % 7);
    }
    EXPECT_EQ(model.digest(), expected);
}

TEST(SceneModel, RemovalIsAnEmptyMeshAndCountsOnce) {
    SceneModel model = begun();
    apply(model, 5, 2, {.epoch = kEpoch});
    model.takeChanges(kNow);
    model.removeNode(5);
    model.removeNode(5);
    model.removeNode(6);
    const auto changes = model.takeChanges(kNow);
    ASSERT_EQ(changes.nodes.size(), 1u);
    EXPECT_EQ(changes.nodes[0].mesh.leaf, 5u);
    EXPECT_TRUE(changes.nodes[0].mesh.isEmpty());
    EXPECT_EQ(model.digest(), NodeDigest());
}

TEST(SceneModel, RemovedNodeCanComeBack) {
    SceneModel model = begun();
    apply(model, 5, 2, {.epoch = kEpoch});
    model.removeNode(5);
    apply(model, 5, 6, {.epoch = kEpoch});
    EXPECT_EQ(model.digest().count(), 1u);
    EXPECT_FALSE(model.takeChanges(kNow).nodes.back().mesh.isEmpty());
}

TEST(SceneModel, AnotherRunReplacesTheModelEvenWithLowerRevisions) {
    SceneModel model = begun();
    apply(model, 5, 20, {.epoch = kEpoch});
    apply(model, 6, 20, {.epoch = kEpoch});
    model.begin(kEpoch + 1);
    apply(model, 5, 0, {.epoch = kEpoch + 1});
    NodeDigest expected;
    expected.add(5, 0);
    EXPECT_EQ(model.digest(), expected);
    const auto changes = model.takeChanges(kNow);
    EXPECT_TRUE(changes.is_cleared);
    ASSERT_EQ(changes.nodes.size(), 1u) << "nothing of the old run may follow the clearing";
    EXPECT_EQ(changes.nodes[0].mesh.revision, 0u);
}

TEST(SceneModel, AnOlderRunOfAnotherServerReplacesIt) {
    SceneModel model = begun();
    apply(model, 5, 20, {.epoch = kEpoch});
    model.begin(kEpoch - 1);
    EXPECT_TRUE(model.takeChanges(kNow).is_cleared);
    apply(model, 6, 0, {.epoch = kEpoch - 1});
    EXPECT_EQ(model.digest().count(), 1u);
    EXPECT_EQ(model.epoch(), kEpoch - 1);
}

TEST(SceneModel, OtherRunsChangeNothing) {
    SceneModel model = begun();
    apply(model, 5, 0, {.epoch = kEpoch});
    const NodeDigest digest = model.digest();
    apply(model, 5, 20, {.epoch = kEpoch - 1});
    apply(model, 6, 20, {.epoch = kEpoch + 1});
    EXPECT_EQ(model.digest(), digest);
    EXPECT_EQ(model.epoch(), kEpoch);
}

TEST(SceneModel, NoNodeIsTakenThatTheOctreeLacks) {
    SceneModel model = begun();
    model.setLeafCount(6);
    apply(model, 5, 0, {.epoch = kEpoch});
    EXPECT_FALSE(model.applyNode({syntheticNode(6, 0), {.epoch = kEpoch}, 1}, kNow));
    EXPECT_EQ(model.digest().count(), 1u);
}

DecodedNode largeNode(uint32_t leaf, size_t triangles, uint32_t revision = 1) {
    DecodedNode node{syntheticNode(leaf, revision), {.epoch = kEpoch}, revision};
    node.mesh.indices.assign(3 * triangles, 0);
    return node;
}

TEST(SceneModel, TrianglesAreBoundedInAll) {
    SceneModel model = begun();
    constexpr size_t kEach = SceneModel::kMaxTriangles / 4 + 1;
    for (uint32_t leaf = 0; leaf < 4; ++leaf)
        EXPECT_EQ(model.applyNode(largeNode(leaf, kEach), kNow), leaf < 3);
    EXPECT_TRUE(model.applyNode(largeNode(2, kEach, 2), kNow)) << "it takes its own place";
    model.removeNode(0);
    EXPECT_TRUE(model.applyNode(largeNode(7, kEach), kNow));
    model.begin(kEpoch + 1);
    model.begin(kEpoch);
    for (uint32_t leaf = 0; leaf < 3; ++leaf) EXPECT_TRUE(model.applyNode(largeNode(leaf, kEach), kNow));
}

std::vector<uint32_t> leavesOf(const SceneModel::Changes& changes) {
    std::vector<uint32_t> leaves;
    for (const SceneModel::Change& change : changes.nodes) leaves.push_back(change.mesh.leaf);
    return leaves;
}

TEST(SceneModel, ABatchComesOutWhole) {
    SceneModel model = begun();
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
    SceneModel model = begun();
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    apply(model, 2, 4, {.epoch = kEpoch, .batch = 2, .batch_nodes = 2});
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    apply(model, 3, 4, {.epoch = kEpoch, .batch = 2, .batch_nodes = 2});
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{1, 2, 3}));
}

// DDS hands out node by node: one of an older batch may come after the first ones of a newer one.
TEST(SceneModel, AnOlderBatchWaitsForTheNewestToo) {
    SceneModel model = begun();
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
    SceneModel model = begun();
    for (int n = 1; n <= 6; ++n) {
        const auto now = kNow + (n - 1) * std::chrono::milliseconds(10);
        apply(model, uint32_t(n), 2, {.epoch = kEpoch, .batch = uint64_t(n), .batch_nodes = 2}, now);
        EXPECT_TRUE(model.takeChanges(now).nodes.empty());
    }
    EXPECT_EQ(model.takeChanges(kNow + std::chrono::milliseconds(51)).nodes.size(), 6u);
}

TEST(SceneModel, NothingWaitsForALostNodeForLong) {
    SceneModel model = begun();
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    EXPECT_TRUE(model.takeChanges(kNow + SceneModel::kLongestWait).nodes.empty());
    const auto late = kNow + SceneModel::kLongestWait + std::chrono::milliseconds(1);
    EXPECT_EQ(leavesOf(model.takeChanges(late)), (std::vector<uint32_t>{1}));
}

TEST(SceneModel, ARemovalDoesNotOvertakeWhatWaits) {
    SceneModel model = begun();
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    model.removeNode(1);
    EXPECT_TRUE(model.takeChanges(kNow).nodes.empty());
    apply(model, 2, 2, {.epoch = kEpoch, .batch = 1, .batch_nodes = 2});
    const SceneModel::Changes changes = model.takeChanges(kNow);
    EXPECT_EQ(leavesOf(changes), (std::vector<uint32_t>{1, 2}));
    EXPECT_TRUE(changes.nodes.at(0).mesh.isEmpty());
    EXPECT_EQ(model.digest().count(), 1u);
}

TEST(SceneModel, AnotherRunForgetsWhatWaits) {
    SceneModel model = begun();
    apply(model, 1, 2, {.epoch = kEpoch, .batch = 9, .batch_nodes = 2});
    model.begin(kEpoch + 1);
    apply(model, 2, 2, {.epoch = kEpoch + 1, .batch = 1, .batch_nodes = 1});
    EXPECT_EQ(leavesOf(model.takeChanges(kNow)), (std::vector<uint32_t>{2}));
}

}  // namespace
}  // namespace bonemill
