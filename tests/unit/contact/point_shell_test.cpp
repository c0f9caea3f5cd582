#include "haptic_server/contact/point_shell.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

using test::bodyVolume;
using test::cubeGeometry;
using test::sphereAt;

std::vector<ShellPoint> pointsOf(const PointShell& shell, LeafId leaf) {
    std::vector<ShellPoint> points;
    shell.forEachBlock(leaf, [&](const ShellBlock& b, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i)
            points.push_back({{b.x[i], b.y[i], b.z[i]}, {b.nx[i], b.ny[i], b.nz[i]}, b.key[i]});
    });
    return points;
}

void expectSameBits(const PointShell& a, const PointShell& b, uint32_t leaves) {
    ASSERT_EQ(a.pointCount(), b.pointCount());
    for (LeafId leaf = 0; leaf < leaves; ++leaf) {
        const auto pa = pointsOf(a, leaf), pb = pointsOf(b, leaf);
        ASSERT_EQ(pa.size(), pb.size()) << "leaf " << leaf;
        for (size_t i = 0; i < pa.size(); ++i) {
            ASSERT_EQ(pa[i].key, pb[i].key);
            ASSERT_EQ(pa[i].position, pb[i].position);
            ASSERT_EQ(pa[i].normal, pb[i].normal);
        }
    }
}

class PointShellAtScale : public testing::TestWithParam<std::tuple<int, int>> {
};  // scaling factor, leaf cells

TEST_P(PointShellAtScale, PointsLieOnTheSphereAndNormalsPointOut) {
    const auto [s, leaf_cells] = GetParam();
    const double h = 0.25e-3;
    const Eigen::Vector3d center = Eigen::Vector3d(5.1, 4.9, 5.03) * 1e-3;
    const double radius = 3.7e-3;
    const VoxelVolume volume = bodyVolume(cubeGeometry(41, h), sphereAt(center, radius));
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(leaf_cells));
    const PointShell shell(volume, lattice, s);
    size_t count = 0;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf)
        for (const ShellPoint& p : pointsOf(shell, leaf)) {
            const Eigen::Vector3d r = p.position.cast<double>() - center;
            // Mean of crossings on a block of s cells: off by at most the sagitta of the block's diagonal.
            EXPECT_LT(std::abs(r.norm() - radius), 3 * s * s * h * h / (8 * radius) * 2 + 1e-7);
            EXPECT_GT(p.normal.cast<double>().dot(r.normalized()), s == 1 ? 0.995 : 0.97);
            ++count;
        }
    EXPECT_EQ(count, shell.pointCount());
    if (leaf_cells % s != 0) return;  // blocks cut at leaf borders: more points than the estimate
    // A surface of area A crosses about 1.5 A / (s h)² blocks of edge s h.
    const double expected = 1.5 * 4 * M_PI * radius * radius / (s * s * h * h);
    EXPECT_NEAR(double(count) / expected, 1, 0.25);
}

TEST_P(PointShellAtScale, IncrementalRefreshGivesTheBitsOfAFullRebuild) {
    const auto [s, leaf_cells] = GetParam();
    const double h = 0.25e-3;
    VoxelVolume volume = bodyVolume(cubeGeometry(37, h), sphereAt(Eigen::Vector3d::Constant(4.6e-3), 3.5e-3));
    LeafLattice lattice(volume, Eigen::Vector3i::Constant(leaf_cells));
    PointShell shell(volume, lattice, s);
    std::mt19937 random(7);
    std::uniform_int_distribution<int> index(0, 36), density(0, kMaxDensity), extent(0, 5);
    for (int edit = 0; edit < 60; ++edit) {
        const Eigen::Vector3i low(index(random), index(random), index(random));
        const IndexBox box =
            IndexBox{low, low + Eigen::Vector3i(extent(random), extent(random), extent(random))}.clamped(
                Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(36));
        for (int k = box.min.z(); k <= box.max.z(); ++k)
            for (int j = box.min.y(); j <= box.max.y(); ++j)
                for (int i = box.min.x(); i <= box.max.x(); ++i)
                    volume.set(i, j, k, Density(density(random)));
        lattice.refreshRanges(volume, box);
        ASSERT_TRUE(shell.refresh(volume, lattice, box));
        expectSameBits(shell, PointShell(volume, lattice, s), lattice.leafCount());
    }
}

INSTANTIATE_TEST_SUITE_P(ScalesAndLeaves, PointShellAtScale,
                         testing::Combine(testing::Values(1, 2, 3), testing::Values(4, 16)));

TEST(PointShell, FullPoolKeepsTheOldPointsAndSaysSo) {
    const VolumeGeometry geometry = cubeGeometry(64, 1e-3);
    VoxelVolume volume(geometry, test::kTestIso);
    volume.set(5, 5, 5, kMaxDensity);
    LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
    PointShell shell(volume, lattice, 1, 0);
    const size_t before = shell.pointCount();
    EXPECT_EQ(before, 8u);
    bool all = true;
    std::mt19937 random(3);
    for (int k = 0; k < 64; ++k)
        for (int j = 0; j < 64; ++j)
            for (int i = 0; i < 64; ++i) volume.set(i, j, k, Density(random()));
    const IndexBox box{Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(63)};
    lattice.refreshRanges(volume, box);
    all = shell.refresh(volume, lattice, box);
    EXPECT_FALSE(all);
    EXPECT_GE(shell.pointCount(), before);
}

TEST(PointShell, FlatDensityHasFiniteNormals) {
    // A checkerboard has zero central-difference gradients.
    VoxelVolume volume(cubeGeometry(8, 1e-3), test::kTestIso);
    for (int k = 0; k < 8; ++k)
        for (int j = 0; j < 8; ++j)
            for (int i = 0; i < 8; ++i) volume.set(i, j, k, (i + j + k) % 2 ? kMaxDensity : 0);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(4));
    const PointShell shell(volume, lattice, 1);
    ASSERT_GT(shell.pointCount(), 0u);
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf)
        for (const ShellPoint& p : pointsOf(shell, leaf)) {
            EXPECT_TRUE(p.position.allFinite());
            EXPECT_TRUE(p.normal.allFinite());
        }
}

}  // namespace
}  // namespace bonemill
