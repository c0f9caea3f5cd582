#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <thread>

#include "common/rt/clock.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

const IndexBox kMilled{{20, 20, 20}, {21, 21, 21}};

class MeshRoundsTest : public testing::Test {
  protected:
    MeshRoundsTest() {
        std::mt19937 random(1);
        test::fillWaves(volume_, random);
    }
    void write(const IndexBox& voxels, Density density) {
        test::writeLikeTick(volume_, lattice_, voxels, [density](int, int, int) { return density; });
    }
    void meshAll() {
        while (!rounds_.hasMeshedAll()) rounds_.round([](NodeGroup&&) {});
    }
    // The leaves come in the order in which the sink got them.
    std::vector<LeafId> roundsLeaves() {
        std::vector<LeafId> leaves;
        is_more_ = rounds_.round([&](NodeGroup&& group) {
            for (const NodeMesh& mesh : group.meshes) leaves.push_back(mesh.leaf);
        });
        return leaves;
    }

    VoxelVolume volume_{test::boxGeometry({64, 64, 64}), 30000};
    LeafLattice lattice_{volume_, {8, 8, 8}};
    SpscRing<Cut> ring_{4};
    MeshRounds rounds_{volume_, lattice_, ring_};
    bool is_more_ = false;
};

TEST_F(MeshRoundsTest, CutLeavesComeBeforeTheRestOfTheBone) {
    write(kMilled, 0);
    write({{20, 20, 20}, {20, 20, 20}}, kMaxDensity);  // the leaf holds surface
    ring_.tryPush(cutOf(kMilled, monotonicNowNs()));
    const std::vector<LeafId> leaves = roundsLeaves();
    ASSERT_FALSE(leaves.empty());
    EXPECT_EQ(leaves.front(), lattice_.leafId({2, 2, 2}));
    EXPECT_EQ(rounds_.cutToSink().count(), 1u);
    EXPECT_TRUE(is_more_);
    EXPECT_FALSE(rounds_.hasMeshedAll());
}

TEST_F(MeshRoundsTest, EachCutIsMeasuredOnceFromTheStartOfItsTick) {
    meshAll();
    const int64_t now_ns = monotonicNowNs();
    for (const int64_t age_ms : {300, 200}) {
        write(kMilled, Density(age_ms));
        ring_.tryPush(cutOf(kMilled, now_ns - age_ms * kNsPerMillisecond));
    }
    roundsLeaves();
    EXPECT_EQ(rounds_.cutToSink().count(), 2u);
    EXPECT_GE(rounds_.cutToSink().maxNs(), 300 * kNsPerMillisecond);
    EXPECT_GE(rounds_.cutToSink().percentileNs(1), 200 * kNsPerMillisecond);
    roundsLeaves();
    EXPECT_EQ(rounds_.cutToSink().count(), 2u);
}

TEST_F(MeshRoundsTest, ACutWaitsForTheLastOfItsMeshes) {
    meshAll();
    const IndexBox two_leaves{{22, 20, 20}, {23, 20, 20}}, in_the_second{{28, 20, 20}, {28, 20, 20}};
    write(two_leaves, 0);
    ring_.tryPush(cutOf(two_leaves, monotonicNowNs()));
    lattice_.beginWrite(in_the_second);  // the next tick is at it
    roundsLeaves();
    EXPECT_EQ(rounds_.cutToSink().count(), 0u);
    EXPECT_TRUE(is_more_);
    lattice_.endWrite(in_the_second);
    roundsLeaves();
    EXPECT_EQ(rounds_.cutToSink().count(), 1u);
}

TEST_F(MeshRoundsTest, ACutThatTheRingDroppedIsMeshedAllTheSame) {
    meshAll();
    for (int n = 0; n < 5; ++n) ring_.tryPush(cutOf(kMilled, monotonicNowNs()));
    ASSERT_EQ(ring_.dropped(), 1u);
    const IndexBox dropped{{40, 40, 40}, {44, 44, 44}};
    write(dropped, 0);
    write({{42, 42, 42}, {42, 42, 42}}, kMaxDensity);
    const LeafId leaf = lattice_.leafId({5, 5, 5});
    const int64_t start_ns = monotonicNowNs();
    bool is_meshed = false;
    while (!is_meshed && monotonicNowNs() - start_ns < 10 * kNsPerSecond) {
        for (const LeafId meshed : roundsLeaves()) is_meshed |= meshed == leaf;
        std::this_thread::sleep_for(MeshRounds::kPeriod);
    }
    EXPECT_TRUE(is_meshed);
    EXPECT_EQ(rounds_.cutToSink().count(), 4u);
}

// The last pass over all leaves was a moment ago.
TEST_F(MeshRoundsTest, FinishMeshesAllThatChangedWithoutWaitingForTheNextPass) {
    meshAll();
    roundsLeaves();
    const IndexBox told{{20, 20, 20}, {20, 20, 20}}, untold{{44, 44, 44}, {44, 44, 44}};
    for (const IndexBox& box : {told, untold}) {
        write(box, 0);
        write(box, kMaxDensity);
    }
    ring_.tryPush(cutOf(told, monotonicNowNs()));
    std::set<LeafId> leaves;
    rounds_.finish(
        [&](NodeGroup&& group) {
            for (const NodeMesh& mesh : group.meshes) leaves.insert(mesh.leaf);
        },
        std::numeric_limits<int64_t>::max());
    EXPECT_TRUE(leaves.contains(lattice_.leafId({2, 2, 2})));
    EXPECT_TRUE(leaves.contains(lattice_.leafId({5, 5, 5})));
    EXPECT_TRUE(roundsLeaves().empty());
}

TEST_F(MeshRoundsTest, FinishEndsInTimeHoweverMuchIsLeft) {
    rounds_.finish([](NodeGroup&&) {}, monotonicNowNs());
    EXPECT_FALSE(rounds_.hasMeshedAll());
}

}  // namespace
}  // namespace bonemill
