#include "haptic_server/contact/point_shell.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using test::bodyVolume;
using test::cubeGeometry;
using test::sphereAt;

const std::vector<ShellLevel> kLevels = {{1}, {2}, {3}};

std::vector<ShellLevel> levelsOf(const std::vector<int>& factors,
                                 ShellNormals normals = ShellNormals::kCentralDifference) {
    std::vector<ShellLevel> levels;
    for (const int factor : factors) levels.push_back({factor, normals});
    return levels;
}

std::vector<ShellPoint> pointsOf(const PointShell& shell, int level, LeafId leaf) {
    std::vector<ShellPoint> points;
    shell.forEachBlock(level, leaf, [&](const ShellBlock& b, uint32_t count) {
        float largest_area = 0;
        for (uint32_t i = 0; i < count; ++i) {
            points.push_back({{b.x[i], b.y[i], b.z[i]}, {b.nx[i], b.ny[i], b.nz[i]}, b.area[i], b.key[i]});
            EXPECT_LE((points.back().position - Eigen::Vector3f(b.center)).norm(), b.radius + 1e-8f);
            largest_area = std::max(largest_area, b.area[i]);
        }
        EXPECT_EQ(largest_area, b.largest_area);
    });
    return points;
}

std::vector<ShellPoint> allPoints(const PointShell& shell, int level, const LeafLattice& lattice) {
    std::vector<ShellPoint> all;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        const auto points = pointsOf(shell, level, leaf);
        EXPECT_EQ(points.size(), shell.pointCount(level, leaf));
        all.insert(all.end(), points.begin(), points.end());
    }
    EXPECT_EQ(all.size(), shell.pointCount(level));
    return all;
}

double totalArea(const std::vector<ShellPoint>& points) {
    double sum = 0;
    for (const ShellPoint& p : points) sum += double(p.area);
    return sum;
}

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

// Slow oracles: the trilinear field and the drawn surface.
double densityAt(const VoxelVolume& volume, const Eigen::Vector3d& p_V) {
    const Eigen::Vector3d at = p_V.cwiseQuotient(volume.spacing());
    const Eigen::Vector3i cell =
        at.array().floor().cast<int>().max(-1).min(volume.dims().array() - 1).matrix();
    const Eigen::Vector3d t = at - cell.cast<double>();
    double density = 0;
    for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3i bit(c & 1, c >> 1 & 1, c >> 2 & 1);
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= bit[axis] ? t[axis] : 1 - t[axis];
        const Eigen::Vector3i voxel = cell + bit;
        density += weight * volume.at(voxel.x(), voxel.y(), voxel.z());
    }
    return density;
}

double meshArea(const VoxelVolume& volume, const LeafLattice& lattice) {
    const MeshGrid grid(volume, lattice);
    double area = 0;
    for (const NodeMesh& mesh : test::meshAll(volume, lattice)) {
        const auto corner = [&](size_t n) {
            return grid.position(grid.stepsOf(mesh.leaf, mesh.vertices[mesh.indices[n]]));
        };
        for (size_t n = 0; n < mesh.indices.size(); n += 3) {
            const Eigen::Vector3d a = corner(n);
            area += (corner(n + 1) - a).cross(corner(n + 2) - a).norm() / 2;
        }
    }
    return area;
}

// A grid of this spacing around the origin of its centre, 20 of the largest voxels to each side.
struct Grid {
    explicit Grid(const Eigen::Vector3d& spacing) : largest(spacing.maxCoeff()) {
        geometry.spacing = spacing;
        geometry.dims = (40 * largest * spacing.cwiseInverse()).array().round().cast<int>() + 1;
        center = geometry.dims.cast<double>().cwiseProduct(spacing) / 2;
    }
    VolumeGeometry geometry;
    double largest;  // m
    Eigen::Vector3d center;
};

std::vector<Eigen::Vector3d> someSpacings() {
    std::vector<Eigen::Vector3d> spacings;
    for (const double h : {0.1e-3, 0.3e-3, 1e-3}) {
        spacings.push_back({h, h, h});
        spacings.push_back({0.5 * h, 0.8 * h, h});
    }
    return spacings;
}

// Zero at 1 with a zero slope, so that a sum over points is as good as an integral.
double bump(double x) {
    return x * x < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

template <class Weight>
double weightedArea(const std::vector<ShellPoint>& points, Weight&& weight) {
    double sum = 0;
    for (const ShellPoint& p : points) sum += double(p.area) * weight(p.position.template cast<double>());
    return sum;
}

TEST(ShellAreas, AddUpToTheSphere) {
    for (const Eigen::Vector3d& spacing : someSpacings()) {
        const Grid grid(spacing);
        const double radius = 12.3 * grid.largest;
        const VoxelVolume volume = bodyVolume(grid.geometry, sphereAt(grid.center, radius));
        const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
        const PointShell shell(volume, lattice, {.levels = kLevels});
        for (int level = 0; level < 3; ++level)
            EXPECT_NEAR(totalArea(allPoints(shell, level, lattice)) / (4 * M_PI * radius * radius), 1, 0.02)
                << spacing.transpose() << " level " << level;
    }
}

TEST(ShellAreas, AddUpToTheCylinder) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (const Eigen::Vector3d& spacing : someSpacings()) {
        const Grid grid(spacing);
        const Eigen::Vector3d axis =
            Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
        const double radius = 9.1 * grid.largest;
        const double length = 15 * grid.largest;
        const VoxelVolume volume = bodyVolume(grid.geometry, [&](const Eigen::Vector3d& p) {
            return (p - grid.center).cross(axis).norm() - radius;
        });
        const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
        const PointShell shell(volume, lattice, {.levels = kLevels});
        const double truth = 2 * M_PI * radius * length * 16 / 15;  // ∫ bump = 16/15
        for (int level = 0; level < 3; ++level) {
            const double area = weightedArea(allPoints(shell, level, lattice), [&](const Eigen::Vector3d& p) {
                const bool is_side = (p - grid.center).cross(axis).norm() > radius / 2;
                return is_side ? bump((p - grid.center).dot(axis) / length) : 0.0;
            });
            EXPECT_NEAR(area / truth, 1, 0.02) << spacing.transpose() << " level " << level;
        }
    }
}

TEST(ShellAreas, AddUpToAPlaneOfAnyOrientation) {
    std::mt19937 random(11);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> shift(-0.5, 0.5);
    const auto spacings = someSpacings();
    for (int n = 0; n < 20; ++n) {
        const Grid grid(spacings[size_t(n) % spacings.size()]);
        const Eigen::Vector3d normal =
            Eigen::Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
        const Eigen::Vector3d point = grid.center + shift(random) * grid.largest * normal;
        const double radius = 17 * grid.largest;
        const VoxelVolume volume = bodyVolume(grid.geometry, test::halfSpace(point, normal));
        const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
        const PointShell shell(volume, lattice, {.levels = kLevels});
        for (int level = 0; level < 3; ++level) {
            const double area = weightedArea(allPoints(shell, level, lattice), [&](const Eigen::Vector3d& p) {
                return bump((p - point).norm() / radius);
            });
            EXPECT_NEAR(area / (M_PI * radius * radius / 3), 1, 0.02)
                << "normal " << normal.transpose() << " level " << level;
        }
    }
}

// The documented bounds: the projection's tolerance above the trilinear surface, and that surface's own error
// beside a sphere.
TEST(ShellPoints, LieOnTheTrilinearSurfaceAndNearTheSphere) {
    for (const ShellNormals normals : {ShellNormals::kTrilinear, ShellNormals::kCentralDifference})
        for (const Eigen::Vector3d& spacing : someSpacings()) {
            const Grid grid(spacing);
            const double h = grid.largest;
            const double radius = 12.3 * h;
            const VoxelVolume volume = bodyVolume(grid.geometry, sphereAt(grid.center, radius));
            const LeafLattice lattice(volume, Eigen::Vector3i(16, 11, 16));
            const PointShell shell(volume, lattice, {.levels = levelsOf({1, 2, 3}, normals)});
            const double counts_per_voxel = kMaxDensity / 4.0;
            const double diagonal = std::sqrt(3.0) * counts_per_voxel;  // largest |density - iso| in a cell
            for (int level = 0; level < 3; ++level)
                for (const ShellPoint& p : allPoints(shell, level, lattice)) {
                    const Eigen::Vector3d p_V = p.position.cast<double>();
                    const Eigen::Vector3d r = p_V - grid.center;
                    ASSERT_LT(std::abs(densityAt(volume, p_V) - volume.iso()),
                              1.1 * double(kProjectionTolerance) * diagonal);
                    ASSERT_LT(std::abs(r.norm() - radius), h * h / (4 * radius) + 1e-3 * h);
                    const double cosine = std::min(1.0, p.normal.cast<double>().dot(r.normalized()));
                    const double limit_deg = normals == ShellNormals::kTrilinear ? 3.5 : 0.3;
                    ASSERT_LT(std::acos(cosine) * 180 / M_PI, limit_deg) << spacing.transpose();
                }
        }
}

TEST(ShellPoints, NoiseGivesPointsOnTheSurfaceWithTheMeshsArea) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        VoxelVolume volume(test::boxGeometry({19, 22, 17}), 30000);
        std::mt19937 random(seed);
        seed % 2 ? test::fillWaves(volume, random) : test::fillNoise(volume, random);
        const LeafLattice lattice(volume, {3, 4, 3});  // small leaves: the mesh's vertices are rounded less
        const PointShell shell(volume, lattice, {.levels = levelsOf({1, 2, 3}, ShellNormals(seed / 2 % 2))});
        const double expected = meshArea(volume, lattice);
        const Eigen::AlignedBox3d inside(  // away from the border's cells, their faces included
            0.01 * volume.spacing(),
            (volume.dims().cast<double>().array() - 1.01).matrix().cwiseProduct(volume.spacing()));
        for (int level = 0; level < 3; ++level) {
            const auto points = allPoints(shell, level, lattice);
            ASSERT_GT(points.size(), 100u);
            EXPECT_NEAR(totalArea(points) / expected, 1, 1e-4) << "seed " << seed << " level " << level;
            for (const ShellPoint& p : points) {
                ASSERT_TRUE(p.position.allFinite());
                ASSERT_TRUE(p.normal.isZero() || std::abs(p.normal.norm() - 1) < 1e-5f);
                ASSERT_GT(p.area, 0);
                const Eigen::Vector3d p_V = p.position.cast<double>();
                // Largest |density - iso|: the noise's own, but for cells at the border of air.
                const bool is_noise = seed % 2 == 0 && inside.exteriorDistance(p_V) == 0;
                const double largest = is_noise ? 150 : kMaxDensity;
                ASSERT_LE(std::abs(densityAt(volume, p_V) - volume.iso()),
                          1.1 * double(kProjectionTolerance) * largest);
            }
        }
    }
}

// Each point lies in its own block.
TEST(ShellPoints, KeepToTheirBlocks) {
    VoxelVolume volume(test::boxGeometry({19, 22, 17}), 30000);
    std::mt19937 random(3);
    test::fillNoise(volume, random);
    const LeafLattice lattice(volume, {7, 5, 8});
    const PointShell shell(volume, lattice, {.levels = kLevels});
    for (int level = 0; level < 3; ++level)
        for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
            const IndexBox cells = lattice.cellsOf(leaf);
            const int s = shell.scalingFactor(level);
            BlockKey last_key;
            for (const ShellPoint& p : pointsOf(shell, level, leaf)) {
                const Eigen::Vector3i block = p.key.index();
                const Eigen::Array3d at = p.position.cast<double>().cwiseQuotient(volume.spacing()).array() -
                                          (cells.min + s * block).cast<double>().array();
                ASSERT_TRUE((at > -1e-4).all() && (at < s + 1e-4).all()) << at.transpose();
                ASSERT_TRUE(p.key > last_key || p.key == BlockKey{});
                last_key = p.key;
            }
        }
}

// leaf cells, normals
class ShellRefresh : public testing::TestWithParam<std::tuple<int, ShellNormals>> {};

// A bone that is edited at random, and what its shell must then be.
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

// All crossings lie in the one voxel: triangles without area.
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
