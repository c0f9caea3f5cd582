#include "haptic_server/assessment/product/zone_tally.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "common/base/units.h"
#include "tests/support/voxel_fields.h"
#include "tests/unit/haptic_server/assessment/product/block_task.h"

namespace bonemill {
namespace {

using test::valueOf;

// A box of 4 x 3 x 2 mm from the top, with a leeway of 0.5 mm around and below, in a block of 10 x 10 x 6 mm.
constexpr double kTop = 6e-3;
bool inBox(const Eigen::Vector3d& p, double grow, double down) {
    return std::abs(p.x() - 5e-3) < 2e-3 + grow && std::abs(p.y() - 5e-3) < 1.5e-3 + grow &&
           p.z() > kTop - 2e-3 - down;
}

test::BlockTask boxTask() {
    test::BlockTask block({40, 40, 24});
    block.addZone("below", ZoneRole::kLeewayBottom, [](const auto& p) { return inBox(p, 0.5e-3, 0.5e-3); });
    block.addZone("beside", ZoneRole::kLeewaySides, [](const auto& p) { return inBox(p, 0.5e-3, 0); });
    block.addZone("box", ZoneRole::kTarget, [](const auto& p) { return inBox(p, 0, 0); });
    block.finishZones();
    return block;
}

TEST(ZoneTally, aCavityCutByPlanesHasTheVolumesOfItsParts) {
    test::BlockTask block = boxTask();
    // It leaves half a millimetre of the box's floor, and goes a quarter into the leeway at the sides.
    block.mill([](const auto& p) { return inBox(p, 0.25e-3, -0.5e-3); });
    const Figures figures = block.figures();
    EXPECT_NEAR(valueOf(figures, "zone.removed_volume:box"), 4 * 3 * 1.5, 1e-9);
    EXPECT_NEAR(valueOf(figures, "zone.removed:box"), 75, 1e-9);
    EXPECT_NEAR(valueOf(figures, "target.left_volume"), 4 * 3 * 0.5, 1e-9);
    EXPECT_NEAR(valueOf(figures, "leeway_sides.removed_volume"), (4.5 * 3.5 - 4 * 3) * 1.5, 1e-9);
    EXPECT_EQ(valueOf(figures, "leeway_bottom.removed"), 0);
    EXPECT_EQ(valueOf(figures, "outside.removed_volume"), 0);
    const double removed = 4.5 * 3.5 * 1.5, ideal = 4 * 3 * 2, both = 4 * 3 * 1.5;
    EXPECT_NEAR(valueOf(figures, "overlap.dice"), 2 * both / (removed + ideal), 1e-12);
    EXPECT_NEAR(valueOf(figures, "overlap.jaccard"), both / (removed + ideal - both), 1e-12);
    EXPECT_NEAR(valueOf(figures, "overlap.precision"), both / removed, 1e-12);
    EXPECT_NEAR(valueOf(figures, "overlap.recall"), both / ideal, 1e-12);
}

TEST(ZoneTally, aBallInABlockHasABallsVolume) {
    test::BlockTask block({48, 48, 48});
    const auto in_ball = [](const auto& p, double radius) {
        return (p - Eigen::Vector3d::Constant(6e-3)).norm() < radius;
    };
    block.addZone("ball", ZoneRole::kTarget, [&](const auto& p) { return in_ball(p, 4e-3); });
    block.finishZones();
    block.mill([&](const auto& p) { return in_ball(p, 3e-3); });
    const Figures figures = block.figures();
    const double small = 4.0 / 3 * std::numbers::pi * 27, large = 4.0 / 3 * std::numbers::pi * 64;
    EXPECT_NEAR(valueOf(figures, "zone.removed_volume:ball") / small, 1, 0.01);
    EXPECT_NEAR(valueOf(figures, "zone.removed:ball"), 100 * small / large, 0.5);
    EXPECT_NEAR(valueOf(figures, "overlap.dice"), 2 * small / (small + large), 0.005);
}

TEST(ZoneTally, densityThatStaysIsPublishedBesideWhatCrossedTheIsoValue) {
    test::BlockTask block = boxTask();
    forEachIndex(block.box(), [&](const Eigen::Vector3i& v) {
        // A third is left of the box: below the iso-value. Beside it, two thirds: above.
        const Eigen::Vector3d p = block.inB(v);
        if (!block.isBlock(v) || !inBox(p, 0.5e-3, 0)) return;
        block.now().set(v.x(), v.y(), v.z(), Density(inBox(p, 0, 0) ? kMaxDensity / 3 : kMaxDensity / 3 * 2));
    });
    const Figures figures = block.figures();
    EXPECT_NEAR(valueOf(figures, "target.removed"), 100, 1e-9);
    EXPECT_NEAR(valueOf(figures, "target.density_removed"), 200.0 / 3, 1e-3);
    EXPECT_EQ(valueOf(figures, "leeway_sides.removed"), 0);
    EXPECT_NEAR(valueOf(figures, "leeway_sides.density_removed"), 100.0 / 3, 1e-3);
}

TEST(ZoneTally, aReferenceTakesThePlaceOfTheTargets) {
    test::BlockTask block = boxTask();
    std::vector<ZoneId> ideal;
    forEachIndex(block.box(), [&](const Eigen::Vector3i& v) { ideal.push_back(block.inB(v).z() > 5e-3); });
    block.task.reference = std::make_shared<const VoxelIds>(block.scanned().dims(), ideal);
    block.mill([](const auto& p) { return p.z() > 5e-3; });
    EXPECT_EQ(valueOf(block.figures(), "overlap.dice"), 1);
    EXPECT_NEAR(valueOf(block.figures(), "overcut.max"), 0, 0.13);  // mm: half a voxel
}

// Random edits of voxels, as the tick makes them: what the running tally has is what a whole count has.
TEST(RunningTally, keepsUpWithAWholeCount) {
    std::mt19937 random(7);
    VoxelVolume scanned(test::boxGeometry({37, 29, 33}), 32768);
    test::fillWaves(scanned, random);
    VoxelVolume now = scanned;
    LeafLattice lattice(now, {8, 8, 8});
    JudgedTask task;
    task.zones = {{"a", ZoneRole::kTarget}, {"b", ZoneRole::kLeewaySides}, {"c", ZoneRole::kContext}};
    std::vector<ZoneId> ids;
    forEachIndex(test::wholeBox(scanned),
                 [&](const Eigen::Vector3i& v) { ids.push_back(ZoneId((v.x() / 9 + v.z() / 11) % 4)); });
    task.map = std::make_shared<const VoxelIds>(scanned.dims(), ids);
    RunningTally tally(scanned, now, lattice, task);
    while (!tally.update(16)) {
    }
    EXPECT_EQ(tally.removed(), (std::vector<int64_t>{0, 0, 0, 0}));
    for (int round = 0; round < 60; ++round) {
        const bool puts_back = round % 5 == 4;
        test::writeLikeTick(now, lattice, test::randomBox(now, 12, random), [&](int i, int j, int k) {
            return puts_back ? scanned.at(i, j, k) : Density(random() % 65536);
        });
        while (!tally.update(16)) {
        }
        const ProductCounts whole = countProduct(scanned, now, task);
        for (size_t zone = 0; zone < whole.zones.size(); ++zone)
            ASSERT_EQ(tally.removed()[zone], whole.zones[zone].removed) << "round " << round;
        ASSERT_EQ(tally.idealRemoved(), whole.ideal_removed);
    }
}

TEST(RunningTally, whatWasNeverWrittenKeepsNobodyWaiting) {
    VoxelVolume volume(test::boxGeometry({40, 40, 40}), 32768);
    volume.fill([](int, int, int) { return kMaxDensity; });
    const VoxelVolume scanned = volume;
    LeafLattice lattice(volume, {4, 4, 4});
    JudgedTask task;
    task.map = std::make_shared<const VoxelIds>(volume.dims(), std::vector<ZoneId>(64000));
    test::writeLikeTick(volume, lattice, {{38, 38, 38}, {38, 38, 38}}, [](int, int, int) { return 0; });
    RunningTally tally(scanned, volume, lattice, task);
    EXPECT_TRUE(tally.update(16));
    EXPECT_EQ(tally.removed()[0], 1) << "in the last of 1331 leaves";
}

TEST(RunningTally, leavesBeingWrittenWait) {
    VoxelVolume volume(test::boxGeometry({16, 16, 16}), 32768);
    volume.fill([](int, int, int) { return kMaxDensity; });
    const VoxelVolume scanned = volume;
    LeafLattice lattice(volume, {8, 8, 8});
    JudgedTask task;
    task.map = std::make_shared<const VoxelIds>(volume.dims(), std::vector<ZoneId>(4096));
    RunningTally tally(scanned, volume, lattice, task);
    while (!tally.update()) {
    }
    const IndexBox box{{4, 4, 4}, {4, 4, 4}};
    lattice.beginWrite(box);
    volume.set(4, 4, 4, 0);
    EXPECT_FALSE(tally.update());
    EXPECT_EQ(tally.removed()[0], 0);
    lattice.endWrite(box);
    EXPECT_TRUE(tally.update());
    EXPECT_EQ(tally.removed()[0], 1);
}

}  // namespace
}  // namespace bonemill
