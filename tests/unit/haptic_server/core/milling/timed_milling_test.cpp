#include "haptic_server/core/milling/timed_milling.h"

#include <gtest/gtest.h>

#include "haptic_server/core/bone/bone_model.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

constexpr double kVoxel = 0.5e-3;
constexpr double kRadius = 2.2e-3;
constexpr double kDt = 1e-3;

BoneModel solidBlock() {
    return BoneModel(
        test::bodyVolume(test::cubeGeometry(33, kVoxel), [](const Eigen::Vector3d&) { return -1.0; }),
        Eigen::Vector3i::Constant(8), ShellConfig{});
}

TEST(TimedMilling, TakesExactlyTheVoxelsInsideTheBurr) {
    BoneModel bone = solidBlock();
    TimedMilling milling({.removal_rate = 1e9}, bone.volume, bone.lattice, kRadius);  // at once
    const Eigen::Vector3d center(8.1e-3, 7.9e-3, 8.3e-3);
    const MillingResult result = milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kDt);
    uint32_t expected = 0;
    for (int k = 0; k < 33; ++k)
        for (int j = 0; j < 33; ++j)
            for (int i = 0; i < 33; ++i) {
                const bool inside = (kVoxel * Eigen::Vector3d(i, j, k) - center).norm() < kRadius;
                expected += inside;
                ASSERT_EQ(bone.volume.at(i, j, k), inside ? 0 : kMaxDensity);
            }
    EXPECT_EQ(result.removed_voxels, expected);
    EXPECT_EQ(result.added_voxels, 0u);
}

TEST(TimedMilling, RateIsDensityPerTimeWhateverTheTick) {
    for (const double dt : {0.25e-3, 1e-3, 4e-3}) {
        BoneModel bone = solidBlock();
        const double rate = 1'000'003.7;  // counts/s: nothing divides evenly
        TimedMilling milling({.removal_rate = rate}, bone.volume, bone.lattice, kRadius);
        const double duration = 0.032;
        for (int n = 0; n < int(duration / dt + 0.5); ++n)
            milling.apply(bone.volume, bone.lattice, bone.shell, {8e-3, 8e-3, 8e-3}, -1, dt);
        EXPECT_NEAR(kMaxDensity - bone.volume.at(16, 16, 16), rate * duration, 1.01) << dt;
    }
}

TEST(TimedMilling, AddingUndoesRemovingAndSaturates) {
    BoneModel bone = solidBlock();
    TimedMilling milling({.removal_rate = 1e9, .addition_rate = 1e9}, bone.volume, bone.lattice, kRadius);
    const Eigen::Vector3d center(8e-3, 8e-3, 8e-3);
    const MillingResult removed = milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kDt);
    const MillingResult added = milling.apply(bone.volume, bone.lattice, bone.shell, center, +1, kDt);
    EXPECT_EQ(removed.removed_voxels, added.added_voxels);
    for (int i = 0; i <= 2; ++i) EXPECT_EQ(bone.volume.at(i, 0, 0), kMaxDensity);
    EXPECT_EQ(bone.volume.at(16, 16, 16), kMaxDensity);
    const MillingResult again = milling.apply(bone.volume, bone.lattice, bone.shell, center, +1, kDt);
    EXPECT_TRUE(again.changed.isEmpty());
}

TEST(TimedMilling, AnUnchangedVoxelMarksNoLeaf) {
    BoneModel bone = solidBlock();
    TimedMilling milling({.removal_rate = 1e9}, bone.volume, bone.lattice, kRadius);
    const Eigen::Vector3d center(8e-3, 8e-3, 8e-3);
    milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kDt);
    std::vector<uint32_t> versions;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        versions.push_back(bone.lattice.version(leaf));
    milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kDt);  // nothing left there
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf) {
        EXPECT_EQ(bone.lattice.version(leaf), versions[leaf]);
        EXPECT_EQ(bone.lattice.version(leaf) % 2, 0u);
    }
}

TEST(TimedMilling, WorksAtAndBeyondTheBorder) {
    BoneModel bone = solidBlock();
    TimedMilling milling({.removal_rate = 1e9}, bone.volume, bone.lattice, kRadius);
    for (const Eigen::Vector3d& center : {Eigen::Vector3d(-1e-3, 0, 0), Eigen::Vector3d(17e-3, 17e-3, 17e-3),
                                          Eigen::Vector3d(1e3, -1e3, 0), Eigen::Vector3d(-5e8, 5e8, 5e8)})
        milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kDt);
    EXPECT_EQ(bone.volume.at(0, 0, 0), 0);
    EXPECT_EQ(bone.volume.at(32, 32, 32), 0);
    EXPECT_EQ(bone.volume.at(-1, 0, 0), 0);  // the border stays air also when adding
    TimedMilling adding({.addition_rate = 1e9}, bone.volume, bone.lattice, kRadius);
    adding.apply(bone.volume, bone.lattice, bone.shell, {0, 0, 0}, +1, kDt);
    EXPECT_EQ(bone.volume.at(0, 0, 0), kMaxDensity);
    EXPECT_EQ(bone.volume.at(-1, 0, 0), 0);
}

// Bricks that a tick has no time for come in the next ones, and in the end nothing is different.
TEST(TimedMilling, ATickWithTooMuchToDoLeavesTheRestForTheNext) {
    constexpr size_t kMaxCells = 1500;
    BoneModel bone = solidBlock(), at_once = solidBlock();
    TimedMilling milling({.removal_rate = 1e9, .most_cells = kMaxCells}, bone.volume, bone.lattice,
                         5 * kVoxel * 2);
    TimedMilling whole({.removal_rate = 1e9}, at_once.volume, at_once.lattice, 5 * kVoxel * 2);
    const Eigen::Vector3d center(8.1e-3, 7.9e-3, 8.3e-3);
    EXPECT_FALSE(whole.apply(at_once.volume, at_once.lattice, at_once.shell, center, -1, kDt).is_cut_short);
    int ticks_cut_short = 0;
    for (int n = 0; n < 20; ++n) {
        const MillingResult result = milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kDt);
        ticks_cut_short += result.is_cut_short;
        EXPECT_LE(result.removed_voxels, kMaxCells);
        if (n == 0) {
            EXPECT_GT(result.removed_voxels, 0u);
        }
    }
    EXPECT_GE(ticks_cut_short, 2);
    EXPECT_LT(ticks_cut_short, 19);
    for (int k = 0; k < 33; ++k)
        for (int j = 0; j < 33; ++j)
            for (int i = 0; i < 33; ++i) ASSERT_EQ(bone.volume.at(i, j, k), at_once.volume.at(i, j, k));
    EXPECT_EQ(bone.shell.pointCount(0), at_once.shell.pointCount(0));
}

// A burr that always finds something to do at one end of a large leaf also comes to the other end.
TEST(TimedMilling, NoBrickOfALargeLeafIsForgottenWhileTheBurrMoves) {
    const auto is_solid = [](const Eigen::Vector3d&) { return -1.0; };
    BoneModel bone(test::bodyVolume(test::cubeGeometry(60, kVoxel), is_solid), Eigen::Vector3i::Constant(64),
                   ShellConfig{});
    const double radius = 20 * kVoxel;
    TimedMilling milling({.removal_rate = 2e5, .most_cells = 12'000}, bone.volume, bone.lattice, radius);
    const Eigen::Vector3d center = Eigen::Vector3d::Constant(30 * kVoxel);
    for (int n = 0; n < 2000; ++n)
        milling.apply(bone.volume, bone.lattice, bone.shell,
                      center + (n % 2 ? 0.5 : -0.5) * kVoxel * Eigen::Vector3d::UnitX(), -1, kDt);
    for (const int side : {-1, 1})
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3i at =
                Eigen::Vector3i::Constant(30) + side * 18 * Eigen::Vector3i(Eigen::Vector3i::Unit(axis));
            EXPECT_EQ(bone.volume.at(at.x(), at.y(), at.z()), 0) << axis << ' ' << side;
        }
}

TEST(TimedMilling, WithoutMemoryForTheChangeNothingIsMilled) {
    BoneModel bone(
        test::bodyVolume(test::cubeGeometry(60, kVoxel), [](const Eigen::Vector3d&) { return -1.0; }),
        Eigen::Vector3i::Constant(16), ShellConfig{});
    TimedMilling milling({.removal_rate = 1e9}, bone.volume, bone.lattice, kVoxel);
    const Eigen::Vector3d inside(12e-3, 12e-3, 12e-3);
    bone.volume.shareUniformBricks();  // and no spare ones
    MillingResult result = milling.apply(bone.volume, bone.lattice, bone.shell, inside, -1, kDt);
    EXPECT_FALSE(result.has_room);
    EXPECT_EQ(result.removed_voxels, 0u);
    EXPECT_EQ(bone.volume.at(24, 24, 24), kMaxDensity);
    bone.volume.makeSpareBricks(8);
    result = milling.apply(bone.volume, bone.lattice, bone.shell, inside, -1, kDt);
    EXPECT_TRUE(result.has_room);
    EXPECT_EQ(bone.volume.at(24, 24, 24), 0);
}

TEST(TimedMilling, ShellAndRangesFollow) {
    BoneModel bone = solidBlock();
    TimedMilling milling({.removal_rate = 4e6}, bone.volume, bone.lattice, kRadius);
    for (int n = 0; n < 40; ++n)
        milling.apply(bone.volume, bone.lattice, bone.shell, {8e-3 + n * 0.1e-3, 8e-3, 8e-3}, -1, kDt);
    const LeafLattice fresh_lattice(bone.volume, Eigen::Vector3i::Constant(8));
    const PointShell fresh_shell(bone.volume, fresh_lattice, ShellConfig{});
    EXPECT_EQ(bone.shell.pointCount(0), fresh_shell.pointCount(0));
    for (LeafId leaf = 0; leaf < fresh_lattice.leafCount(); ++leaf) {
        EXPECT_EQ(bone.shell.pointCount(0, leaf), fresh_shell.pointCount(0, leaf));
        EXPECT_EQ(bone.lattice.range(0, leaf).min, fresh_lattice.range(0, leaf).min);
        EXPECT_EQ(bone.lattice.range(0, leaf).max, fresh_lattice.range(0, leaf).max);
    }
}

}  // namespace
}  // namespace bonemill
