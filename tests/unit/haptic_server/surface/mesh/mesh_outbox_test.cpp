#include "haptic_server/surface/mesh/mesh_outbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace bonemill {
namespace {

constexpr int64_t kSecond = 1'000'000'000;
constexpr int64_t kAll = INT64_MAX;
const Eigen::Vector3f kOrigin = Eigen::Vector3f::Zero();

// Makes one triangle at x metres from the origin.
NodeMesh meshOf(uint32_t leaf, uint32_t revision, float x = 0) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    mesh.revision = revision;
    mesh.origin = {x, 0, 0};
    mesh.step.setConstant(1e-6f);
    mesh.vertices.resize(3);
    mesh.indices = {0, 1, 2};
    return mesh;
}
NodeMesh emptyMeshOf(uint32_t leaf, uint32_t revision) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    mesh.revision = revision;
    return mesh;
}

NodeGroup groupOf(std::vector<NodeMesh> meshes, int64_t cut_ns = 0) {
    NodeGroup group;
    group.meshes = std::move(meshes);
    group.oldest_cut_ns = cut_ns;
    return group;
}

std::vector<std::vector<uint32_t>> leavesOf(const std::vector<NodeGroup>& groups) {
    std::vector<std::vector<uint32_t>> leaves;
    for (const NodeGroup& group : groups) {
        leaves.emplace_back();
        for (const NodeMesh& mesh : group.meshes) leaves.back().push_back(mesh.leaf);
    }
    return leaves;
}
using Leaves = std::vector<std::vector<uint32_t>>;

TEST(MeshOutbox, HoldsTheNewestMeshOfEachLeafUntilItIsTaken) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(7, 2)}), 0);
    outbox.put(groupOf({meshOf(7, 6)}), 0);
    outbox.put(groupOf({meshOf(7, 4)}), 0);  // put back: DDS refused it, and the mesher was faster
    const auto taken = outbox.takeNearest(kOrigin, kAll, 0);
    ASSERT_EQ(leavesOf(taken), (Leaves{{7}}));
    EXPECT_EQ(taken[0].meshes[0].revision, 6u);
    EXPECT_TRUE(outbox.isEmpty());
    EXPECT_TRUE(outbox.takeNearest(kOrigin, kAll, 0).empty());
}

// Returns at once, or the test's time-out ends it.
TEST(MeshOutbox, WakesWhoeverAwaitsAGroup) {
    MeshOutbox outbox;
    std::jthread mesher([&outbox] { outbox.put(groupOf({meshOf(7, 2)}), 1); });
    EXPECT_TRUE(outbox.awaitPut(std::chrono::hours(1)));
    outbox.put(groupOf({meshOf(8, 2)}), 1);
    EXPECT_TRUE(outbox.awaitPut(std::chrono::hours(1))) << "it was put before";
}

// Or a network without room would keep the publisher awake.
TEST(MeshOutbox, WhatWaitsOrComesBackWakesNobody) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(7, 2)}), 1);
    EXPECT_TRUE(outbox.awaitPut(std::chrono::hours(1)));
    EXPECT_FALSE(outbox.awaitPut(std::chrono::milliseconds(1))) << "it still waits";
    std::vector<NodeGroup> taken = outbox.takeNearest(kOrigin, kAll, 2);
    outbox.put(std::move(taken.at(0)), 3);
    EXPECT_FALSE(outbox.awaitPut(std::chrono::milliseconds(1)));
}

TEST(MeshOutbox, GivesTheNearestFirstAndWithinTheBudget) {
    MeshOutbox outbox;
    for (const float x : {0.05f, 0.01f, 0.03f}) outbox.put(groupOf({meshOf(uint32_t(x * 100), 2, x)}), 0);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 0)), (Leaves{{1}}));
    EXPECT_TRUE(outbox.takeNearest(kOrigin, 0, 0).empty());
    EXPECT_EQ(leavesOf(outbox.takeNearest({0.1f, 0, 0}, kAll, 0)), (Leaves{{5}, {3}}));
}

TEST(MeshOutbox, WhatWaitsLongGoesBeforeWhatIsNear) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(9, 2, 0.15f)}), 0);
    outbox.put(groupOf({meshOf(1, 2, 0.01f)}), 2 * kSecond);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 2 * kSecond)), (Leaves{{9}}));
}

TEST(MeshOutbox, AGroupStaysTogetherWhateverTheBudget) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(1, 2, 0.01f), meshOf(2, 2, 0.02f), meshOf(3, 2, 0.03f)}), 0);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 0)), (Leaves{{1, 2, 3}}));
}

TEST(MeshOutbox, GroupsThatShareALeafBecomeOne) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(1, 2), meshOf(2, 2)}, 500), 0);
    outbox.put(groupOf({meshOf(5, 2)}, 100), 0);
    outbox.put(groupOf({meshOf(2, 4), meshOf(3, 2)}, 700), 0);
    const auto taken = outbox.takeNearest(kOrigin, kAll, 0);
    ASSERT_EQ(leavesOf(taken), (Leaves{{5}, {1, 2, 3}}));
    EXPECT_EQ(taken[1].meshes[1].revision, 4u);
    EXPECT_EQ(taken[1].oldest_cut_ns, 500) << "the older cut is still unseen";
}

// The leaf itself was meshed a moment before, by a pass over all that changed.
TEST(MeshOutbox, ANeighbourThatWaitsBelongsToTheGroup) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(1, 2, 0.2f)}), 0);
    NodeGroup group = groupOf({meshOf(2, 2)}, 300);
    group.neighbours = {1, 2, 3};
    outbox.put(std::move(group), 0);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 0)), (Leaves{{1, 2}}));
}

TEST(MeshOutbox, AGroupPutBackIsTheSameGroup) {
    MeshOutbox outbox;
    NodeGroup group = groupOf({meshOf(1, 2), emptyMeshOf(2, 4)}, 300);
    group.neighbours = {8};
    outbox.put(std::move(group), 0);
    auto taken = outbox.takeNearest(kOrigin, kAll, 0);
    ASSERT_EQ(taken.size(), 1u);
    outbox.put(std::move(taken[0]), 0);
    outbox.put(groupOf({meshOf(8, 2)}), 0);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, kAll, 0)), (Leaves{{1, 2, 8}}));
}

// DDS may refuse a group again and again.
TEST(MeshOutbox, AGroupPutBackHasWaitedAllTheTime) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(9, 2, 0.15f)}), kSecond);
    auto taken = outbox.takeNearest(kOrigin, kAll, 3 * kSecond);
    ASSERT_EQ(taken.size(), 1u);
    outbox.put(std::move(taken[0]), 3 * kSecond);
    outbox.put(groupOf({meshOf(1, 2, 0.01f)}), 3 * kSecond);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 3 * kSecond)), (Leaves{{9}}));
}

TEST(MeshOutbox, TheWholeIsNotGivenWhileAPartOfItWasPutBack) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(1, 2)}), 10);
    outbox.markWhole(20);
    for (int64_t now_ns : {30, 40}) {
        auto taken = outbox.takeNearest(kOrigin, kAll, now_ns);
        ASSERT_EQ(taken.size(), 1u);
        outbox.put(std::move(taken[0]), now_ns);
        EXPECT_FALSE(outbox.hasGivenWhole()) << now_ns;
    }
    outbox.takeNearest(kOrigin, kAll, 50);
    EXPECT_TRUE(outbox.hasGivenWhole());
}

// A restore changes many leaves far away, and empties one.
TEST(MeshOutbox, AnEmptiedLeafDoesNotMakeItsGroupNear) {
    MeshOutbox outbox;
    outbox.put(groupOf({emptyMeshOf(1, 2), meshOf(2, 2, 0.2f)}), 0);
    outbox.put(groupOf({meshOf(3, 2, 0.01f)}), 0);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 0)), (Leaves{{3}}));
}

TEST(MeshOutbox, WaitingDoesNotPileUpNeighbours) {
    MeshOutbox outbox;
    for (uint32_t n = 0; n < 100; ++n) {
        NodeGroup group = groupOf({meshOf(1, 2 * n + 2)});
        group.neighbours = {1, 2, 3};
        outbox.put(std::move(group), 0);
    }
    const auto taken = outbox.takeNearest(kOrigin, kAll, 0);
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_EQ(taken[0].neighbours, (std::vector<uint32_t>{2, 3}));
}

// Milling goes on while the first model waits for its turn: what it adds does not count.
TEST(MeshOutbox, TheWholeIsGivenWhenAllThatWasThereIs) {
    MeshOutbox outbox;
    outbox.put(groupOf({meshOf(1, 2, 0.01f)}), 10);
    outbox.put(groupOf({meshOf(2, 2, 0.05f)}), 10);
    EXPECT_FALSE(outbox.hasGivenWhole());
    outbox.markWhole(20);
    outbox.put(groupOf({meshOf(3, 2, 0.002f)}), 30);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 30)), (Leaves{{3}}));
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 30)), (Leaves{{1}}));
    EXPECT_FALSE(outbox.hasGivenWhole());
    outbox.put(groupOf({meshOf(4, 2, 0.09f)}), 40);
    EXPECT_EQ(leavesOf(outbox.takeNearest(kOrigin, 1, 40)), (Leaves{{2}}));
    EXPECT_TRUE(outbox.hasGivenWhole());
}

}  // namespace
}  // namespace bonemill
