#include "haptic_server/core/bone/bone_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/haptic_server/core/bone/milled_ball.h"

namespace bonemill {
namespace {

using test::MilledBall;

TEST(BoneHistory, GivesBackTheScannedBoneAndItsShell) {
    MilledBall ball;
    const BoneModel original = MilledBall::makeBone();
    ball.groove(9e-3);
    ASSERT_NE(ball.densities(), MilledBall::densitiesOf(original));
    EXPECT_FALSE(ball.history.isRestoring());
    ball.history.restore();
    EXPECT_TRUE(ball.history.isRestoring());
    EXPECT_GT(ball.restoreAll(), 1);  // spread over ticks
    EXPECT_EQ(ball.densities(), MilledBall::densitiesOf(original));
    BoneModel& bone = ball.bone;
    EXPECT_GT(bone.shell.staleLeaves(1), 0u);
    EXPECT_TRUE(bone.shell.prepare(bone.volume, bone.lattice, 1, int(bone.lattice.leafCount())).is_ready);
    for (int level = 0; level < 2; ++level)
        EXPECT_EQ(bone.shell.pointCount(level), original.shell.pointCount(level));
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        EXPECT_EQ(bone.lattice.version(leaf) % 2, 0u);
}

TEST(BoneHistory, CountsWhatIsMissingWhateverWasMilledAddedAndPutBack) {
    MilledBall ball;
    const int64_t scanned = ball.voxelsOfBone();
    const auto expectTrue = [&] { EXPECT_EQ(ball.history.missingVoxels(), scanned - ball.voxelsOfBone()); };
    ball.groove(9e-3);
    EXPECT_GT(ball.history.missingVoxels(), 100);
    expectTrue();
    ball.checkpoints.save(1);
    const int64_t then = ball.history.missingVoxels();
    EXPECT_EQ(ball.checkpoints.kept()[0].snapshot->missing_voxels, then);
    ball.groove(13e-3);
    ball.groove(1e-3, 2e-3, +1);
    expectTrue();
    ASSERT_TRUE(ball.checkpoints.restore(1));
    for (int n = 0; n < 3; ++n) ball.restoreSome();
    expectTrue();
    ball.restoreAll();
    expectTrue();
    EXPECT_EQ(ball.history.missingVoxels(), then);
    ball.checkpoints.restore(Checkpoints::kScannedBone);
    ball.restoreAll();
    EXPECT_EQ(ball.history.missingVoxels(), 0);
}

TEST(BoneHistory, EveryCheckpointComesBackBitByBit) {
    MilledBall ball;
    std::vector<std::vector<Density>> states;
    for (int n = 0; n < 4; ++n) {
        ball.groove(6e-3 + n * 2.5e-3);
        EXPECT_EQ(ball.checkpoints.save(n), uint32_t(n + 1));
        states.push_back(ball.densities());
    }
    for (const uint32_t id : {2u, 4u, 1u, 1u, 3u}) {
        ball.groove(10e-3, 7e-3 + id * 1e-3);
        ASSERT_TRUE(ball.checkpoints.restore(id));
        ball.restoreAll();
        EXPECT_EQ(ball.densities(), states[id - 1]) << id;
    }
}

TEST(BoneHistory, TheNewestOfTwoOrdersCountsAlsoHalfWayThere) {
    MilledBall ball;
    ball.groove(7e-3);
    ball.checkpoints.save(0);
    const auto first = ball.densities();
    ball.groove(13e-3);
    ball.checkpoints.save(1);
    ball.groove(10e-3, 8e-3);
    ball.checkpoints.restore(2);
    for (int n = 0; n < 3; ++n) ASSERT_TRUE(ball.restoreSome());
    ball.checkpoints.restore(0);
    ASSERT_TRUE(ball.restoreSome());
    ball.checkpoints.restore(2);
    ball.checkpoints.restore(1);  // two before the tick looks
    ball.restoreAll();
    EXPECT_EQ(ball.densities(), first);
}

int aliveOf(const std::vector<std::weak_ptr<const BoneSnapshot>>& snapshots) {
    return int(std::count_if(snapshots.begin(), snapshots.end(), [](const auto& s) { return !s.expired(); }));
}

// This is so while the server waits for a device.
TEST(BoneHistory, WithoutATickOnlyTheNewestOrderIsKept) {
    MilledBall ball;
    ball.groove(7e-3);
    std::vector<std::weak_ptr<const BoneSnapshot>> asked_for;
    for (int n = 0; n < 100; ++n) {
        const auto snapshot = std::make_shared<const BoneSnapshot>();
        ball.history.restore(snapshot);
        asked_for.push_back(snapshot);
    }
    EXPECT_EQ(aliveOf(asked_for), 1);
    EXPECT_FALSE(asked_for.back().expired());
    ball.restoreAll();
    EXPECT_EQ(ball.densities(), MilledBall::densitiesOf(MilledBall::makeBone()));
}

TEST(BoneHistory, OrdersFasterThanTheTickCarriesThemOutDoNotPileUp) {
    MilledBall ball;
    ball.groove(7e-3);
    std::vector<std::weak_ptr<const BoneSnapshot>> asked_for;
    for (int n = 0; n < 100; ++n) {
        for (int of_one_tick = 0; of_one_tick < 1 + n % 3; ++of_one_tick) {
            const auto snapshot = std::make_shared<const BoneSnapshot>();
            ball.history.restore(snapshot);
            asked_for.push_back(snapshot);
        }
        ASSERT_LE(aliveOf(asked_for), 2) << n;  // the one under way and the one to come
        ASSERT_TRUE(ball.restoreSome());
    }
    ball.restoreAll();
    EXPECT_EQ(ball.densities(), MilledBall::densitiesOf(MilledBall::makeBone()));
}

TEST(BoneHistory, AskedForAgainOnTheWayItArrivesAsSoon) {
    const auto ticksOf = [](bool is_repeated, uint32_t id) {
        MilledBall ball;
        ball.groove(7e-3);
        ball.checkpoints.save(0);
        ball.groove(13e-3);
        ball.checkpoints.restore(id);
        int ticks = 0;
        for (; ball.restoreSome() && ticks < 1000; ++ticks)
            if (is_repeated && ball.history.isRestoring()) ball.checkpoints.restore(id);
        return ticks;
    };
    for (const uint32_t id : {Checkpoints::kScannedBone, 1u}) {
        EXPECT_GT(ticksOf(false, id), 3);
        EXPECT_EQ(ticksOf(true, id), ticksOf(false, id));
    }
}

// Nothing in between can be saved: what is saved on the way is where the way leads.
TEST(BoneHistory, SavedOnTheWayBackItIsTheTarget) {
    MilledBall ball;
    ball.groove(7e-3);
    ball.checkpoints.save(0);
    const auto first = ball.densities();
    ball.groove(13e-3);
    ball.checkpoints.restore(1);
    ASSERT_TRUE(ball.restoreSome());
    EXPECT_EQ(ball.checkpoints.save(1), 2u);
    ball.checkpoints.restore(Checkpoints::kScannedBone);
    EXPECT_EQ(ball.checkpoints.save(2), 3u);
    ball.restoreAll();
    ball.checkpoints.restore(2);
    ball.restoreAll();
    EXPECT_EQ(ball.densities(), first);
    ball.checkpoints.restore(3);
    ball.restoreAll();
    EXPECT_EQ(ball.densities(), MilledBall::densitiesOf(MilledBall::makeBone()));
}

TEST(BoneHistory, LeavesAsScannedCostNothingAndUnchangedOnesAreShared) {
    MilledBall ball;
    ball.checkpoints.save(0);
    EXPECT_TRUE(ball.checkpoints.kept()[0].snapshot->leaves.empty());
    ball.groove(7e-3, 14e-3);
    ball.checkpoints.save(1);
    ball.groove(13e-3, 6e-3);
    ball.checkpoints.save(2);
    const auto &before = ball.checkpoints.kept()[1].snapshot->leaves,
               &after = ball.checkpoints.kept()[2].snapshot->leaves;
    EXPECT_GT(before.size(), 0u);
    EXPECT_GT(after.size(), before.size());
    EXPECT_LT(after.size(), ball.bone.lattice.leafCount() / 2);
    size_t shared = 0;
    for (const auto& leaf : before) shared += std::find(after.begin(), after.end(), leaf) != after.end();
    EXPECT_GT(shared, before.size() / 2);
    ball.history.restore();
    ball.restoreAll();
    ball.checkpoints.save(3);
    EXPECT_TRUE(ball.checkpoints.kept()[3].snapshot->leaves.empty());
}

TEST(BoneHistory, TheOldestCheckpointGoesAndIdsAreNotGivenAgain) {
    MilledBall ball;
    for (size_t n = 0; n < Checkpoints::kMax + 2; ++n) ball.checkpoints.save(double(n));
    EXPECT_EQ(ball.checkpoints.kept().size(), Checkpoints::kMax);
    EXPECT_EQ(ball.checkpoints.kept().front().id, 3u);
    EXPECT_EQ(ball.checkpoints.kept().front().session_s, 2);
    EXPECT_FALSE(ball.checkpoints.restore(2));
    EXPECT_FALSE(ball.checkpoints.restore(11));
    EXPECT_TRUE(ball.checkpoints.restore(10));
}

// A checkpoint that is dropped while the tick is on its way there stays until it is.
TEST(BoneHistory, ADroppedCheckpointIsStillReached) {
    MilledBall ball;
    ball.groove(7e-3);
    ball.checkpoints.save(0);
    const auto first = ball.densities();
    ball.groove(13e-3);
    ball.checkpoints.restore(1);
    ASSERT_TRUE(ball.restoreSome());
    for (size_t n = 0; n < Checkpoints::kMax; ++n) ball.checkpoints.save(1);
    EXPECT_FALSE(ball.checkpoints.restore(1));
    ball.restoreAll();
    EXPECT_EQ(ball.densities(), first);
}

// As of an earlier run of the session: nothing was ever written in this one.
TEST(BoneHistory, ASnapshotOfAnotherRunIsRestoredWhereNothingWasMilled) {
    test::MilledBall before, after;
    before.groove(10e-3);
    const auto snapshot = before.history.snapshot(before.bone);
    ASSERT_FALSE(snapshot->leaves.empty());
    after.history.restore(snapshot);
    after.restoreAll();
    EXPECT_EQ(after.densities(), before.densities());
    EXPECT_EQ(after.history.missingVoxels(), before.history.missingVoxels());
}

}  // namespace
}  // namespace bonemill
