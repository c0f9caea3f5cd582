// The shell follows an edited bone and keeps its levels and its limits.
#include "haptic_server/core/contact/point_shell.h"

#include <random>
#include <tuple>

#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"
#include "tests/unit/haptic_server/core/contact/shell_points.h"

namespace bonemill {
namespace {

using namespace test;

void expectSameLeaf(const PointShell& a, const PointShell& b, int level, LeafId leaf) {
    const auto pa = pointsOf(a, level, leaf), pb = pointsOf(b, level, leaf);
    ASSERT_EQ(pa.size(), pb.size()) << "level " << level << " leaf " << leaf;
    for (size_t i = 0; i < pa.size(); ++i) {
        ASSERT_EQ(pa[i].key, pb[i].key);
        ASSERT_EQ(pa[i].position, pb[i].position);
        ASSERT_EQ(pa[i].normal, pb[i].normal);
        ASSERT_EQ(pa[i].area, pb[i].area);
    }
}

void expectSameBits(const PointShell& a, const PointShell& b, int level, uint32_t leaves) {
    EXPECT_EQ(a.staleLeaves(level), 0u);
    ASSERT_EQ(a.pointCount(level), b.pointCount(level));
    for (LeafId leaf = 0; leaf < leaves; ++leaf) expectSameLeaf(a, b, level, leaf);
}

// The pairs are leaf cells and normals.
class ShellRefresh : public testing::TestWithParam<std::tuple<int, ShellNormals>> {};

// The bone is edited at random; rebuilt() is what its shell must then be.
struct EditedBone {
    EditedBone(int leaf_cells, std::vector<ShellLevel> levels)
        : volume(bodyVolume(test::boxGeometry({37, 31, 34}),
                            sphereAt(Eigen::Vector3d(7e-3, 8e-3, 12e-3), 6.3e-3))),
          lattice(volume, Eigen::Vector3i::Constant(leaf_cells)),
          config{.levels = std::move(levels), .spare_points = 60'000},
          shell(volume, lattice, config) {}

    void edit() {
        std::uniform_int_distribution<int> density(0, kMaxDensity), way(0, 2);
        const IndexBox box = test::randomBox(volume, 6, random);
        const int what = way(random);  // noise, all bone, all air
        test::writeLikeTick(volume, lattice, box, [&](int, int, int) {
            return what == 0 ? Density(density(random)) : what == 1 ? kMaxDensity : Density(0);
        });
        ASSERT_TRUE(shell.refresh(volume, lattice, {&box, 1}));
    }
    PointShell rebuilt() const { return PointShell(volume, lattice, config); }

    VoxelVolume volume;
    LeafLattice lattice;
    ShellConfig config;
    PointShell shell;
    std::mt19937 random{7};
};

TEST_P(ShellRefresh, GivesTheBitsOfAFullRebuildAtTheFollowedLevel) {
    const auto [leaf_cells, normals] = GetParam();
    for (int level = 0; level < 3; ++level) {
        EditedBone bone(leaf_cells, levelsOf({3, 1, 2}, normals));
        bone.shell.follow(level);
        for (int n = 0; n < 30; ++n) {
            bone.edit();
            expectSameBits(bone.shell, bone.rebuilt(), level, bone.lattice.leafCount());
        }
    }
}

TEST_P(ShellRefresh, FollowsOneLevelWhileAnotherIsPrepared) {
    const auto [leaf_cells, normals] = GetParam();
    EditedBone bone(leaf_cells,
                    {{1, normals}, {2, ShellNormals::kTrilinear}, {3, ShellNormals::kCentralDifference}});
    std::uniform_int_distribution<int> any_level(0, 2), some(0, int(bone.lattice.leafCount()) / 4 + 1),
        die(0, 9);
    int switches = 0;
    for (int n = 0, wanted = 0; n < 200; ++n) {
        bone.edit();
        if (die(bone.random) == 0) wanted = any_level(bone.random);
        const size_t stale = bone.shell.staleLeaves(wanted);
        const int most = some(bone.random);
        const auto [is_ready, is_complete] = bone.shell.prepare(bone.volume, bone.lattice, wanted, most);
        EXPECT_TRUE(is_complete);
        EXPECT_EQ(bone.shell.staleLeaves(wanted), stale - std::min(stale, size_t(most)));
        EXPECT_EQ(is_ready, bone.shell.staleLeaves(wanted) == 0);
        if (is_ready && wanted != bone.shell.followed()) {
            bone.shell.follow(wanted);
            ++switches;
        }
        const PointShell rebuilt = bone.rebuilt();
        expectSameBits(bone.shell, rebuilt, bone.shell.followed(), bone.lattice.leafCount());
        if (is_ready) expectSameBits(bone.shell, rebuilt, wanted, bone.lattice.leafCount());
    }
    EXPECT_GT(switches, 4);
}

TEST(PointShell, KeepsNoLevelUpToDateThatNobodyWants) {
    EditedBone bone(8, levelsOf({1, 2, 3}));
    bone.edit();
    EXPECT_EQ(bone.shell.staleLeaves(0), 0u);
    EXPECT_GT(bone.shell.staleLeaves(1), 0u);
    EXPECT_GT(bone.shell.staleLeaves(2), 0u);
    EXPECT_TRUE(bone.shell.prepare(bone.volume, bone.lattice, 1, 1000).is_ready);
    bone.edit();
    EXPECT_EQ(bone.shell.staleLeaves(1), 0u);  // kept while it is being prepared
    bone.shell.follow(0);
    bone.edit();
    EXPECT_GT(bone.shell.staleLeaves(1), 0u);
}

INSTANTIATE_TEST_SUITE_P(LeavesAndNormals, ShellRefresh,
                         testing::Combine(testing::Values(4, 16, 40),
                                          testing::Values(ShellNormals::kTrilinear,
                                                          ShellNormals::kCentralDifference)));

TEST(PointShell, CrossesAsManyBlocksAsTheSurfaceDoes) {
    const double h = 0.25e-3;
    const double radius = 3.7e-3;
    const VoxelVolume volume = bodyVolume(cubeGeometry(41, h), sphereAt({5.1e-3, 4.9e-3, 5.03e-3}, radius));
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(12));
    const PointShell shell(volume, lattice, {.levels = kLevels});
    for (int level = 0; level < 3; ++level) {
        // A surface of area A crosses about 1.5 A / (s h)² blocks of edge s h.
        const int s = shell.scalingFactor(level);
        const double expected = 1.5 * 4 * M_PI * radius * radius / (s * s * h * h);
        EXPECT_NEAR(double(shell.pointCount(level)) / expected, 1, 0.25);
    }
}

TEST(PointShell, LevelsAreFoundByTheirFactor) {
    const VoxelVolume volume(cubeGeometry(8, 1e-3), test::kTestIso);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(4));
    const PointShell shell(volume, lattice, {.levels = {{3}, {1}}});
    EXPECT_EQ(shell.levelCount(), 2);
    EXPECT_EQ(shell.levelOf(3), 0);
    EXPECT_EQ(shell.levelOf(1), 1);
    EXPECT_EQ(shell.levelOf(2), -1);
    EXPECT_EQ(shell.scalingFactor(0), 3);
}

TEST(PointShell, RefusesFactorsThatAreNoneOrNotDistinct) {
    const VoxelVolume volume(cubeGeometry(8, 1e-3), test::kTestIso);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(4));
    for (const std::vector<int>& factors :
         {std::vector<int>{}, std::vector<int>{0}, std::vector<int>{1, -2}, std::vector<int>{2, 1, 2}})
        EXPECT_THROW(PointShell(volume, lattice, {.levels = levelsOf(factors)}), std::invalid_argument);
}

// All crossings lie in the one voxel, so that the triangles have no area.
TEST(PointShell, SurfaceThatOnlyTouchesAVoxelGivesNoPoint) {
    VoxelVolume volume(cubeGeometry(8, 1e-3), test::kTestIso);
    volume.set(3, 3, 3, test::kTestIso);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(4));
    const PointShell shell(volume, lattice, {.levels = kLevels});
    for (int level = 0; level < 3; ++level) EXPECT_EQ(shell.pointCount(level), 0u);
}

TEST(PointShell, FullPoolKeepsTheOldPointsAndSaysSo) {
    const VolumeGeometry geometry = cubeGeometry(64, 1e-3);
    VoxelVolume volume(geometry, test::kTestIso);
    volume.set(5, 5, 5, kMaxDensity);
    LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
    PointShell shell(volume, lattice, {.spare_points = 0});
    const size_t before = shell.pointCount(0);
    EXPECT_EQ(before, 8u);
    bool all = true;
    std::mt19937 random(3);
    for (int k = 0; k < 64; ++k)
        for (int j = 0; j < 64; ++j)
            for (int i = 0; i < 64; ++i) volume.set(i, j, k, Density(random()));
    const IndexBox box{Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(63)};
    lattice.refreshRanges(volume, box);
    all = shell.refresh(volume, lattice, {&box, 1});
    EXPECT_FALSE(all);
    EXPECT_GE(shell.pointCount(0), before);
}

TEST(PointShell, FlatDensityHasFiniteNormals) {
    // A checkerboard has zero central-difference gradients.
    VoxelVolume volume(cubeGeometry(8, 1e-3), test::kTestIso);
    for (int k = 0; k < 8; ++k)
        for (int j = 0; j < 8; ++j)
            for (int i = 0; i < 8; ++i) volume.set(i, j, k, (i + j + k) % 2 ? kMaxDensity : 0);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(4));
    const PointShell shell(volume, lattice, ShellConfig{});
    ASSERT_GT(shell.pointCount(0), 0u);
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf)
        for (const ShellPoint& p : pointsOf(shell, 0, leaf)) {
            EXPECT_TRUE(p.position.allFinite());
            EXPECT_TRUE(p.normal.allFinite());
        }
}

}  // namespace
}  // namespace bonemill
