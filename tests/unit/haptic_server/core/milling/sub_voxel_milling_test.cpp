// After milling below the voxel size the surface that stays is the burr's own.
#include <gtest/gtest.h>

#include "haptic_server/core/milling/timed_milling.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/bone_volume.h"
#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr double kFineVoxel = 0.125e-3;
constexpr double kTickTime = 1e-3;
constexpr double kAtOnce = 1e9;  // counts/s: all that may go goes in one tick
constexpr double kInTwentyTicks = 12750 * kDensityCountsPerUnit;  // counts/s: from full to nothing in 20 ms
const std::vector<Eigen::Vector3d> kSpacings = {{kFineVoxel, kFineVoxel, kFineVoxel},
                                                {0.6 * kFineVoxel, kFineVoxel, 0.8 * kFineVoxel}};
constexpr Density kIsos[] = {32768, 26214, 45000, 9000};

BoneModel filled(const Eigen::Vector3i& dims, const Eigen::Vector3d& spacing, Density iso, Density density) {
    VoxelVolume volume(test::boxGeometry(dims, spacing), iso);
    test::forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) { volume.set(i, j, k, density); });
    return BoneModel(std::move(volume), Eigen::Vector3i(16, 12, 16), {.levels = {{1}, {2}, {3}}});
}

// The cube has this edge length, m, whatever the spacing.
BoneModel cube(double side, const Eigen::Vector3d& spacing, Density iso, Density density) {
    return filled((side * spacing.cwiseInverse()).array().ceil().cast<int>() + 1, spacing, iso, density);
}

MillingConfig atOnce() {
    return {.removal_rate = kAtOnce, .addition_rate = kAtOnce, .shape = MillingShape::kSubVoxel};
}

Eigen::Vector3d positionOf(const VoxelVolume& volume, int i, int j, int k) {
    return volume.spacing().cwiseProduct(Eigen::Vector3d(i, j, k));
}

// As a slow oracle, this is the distance from the sphere that is larger by the sag of
// the interpolated distance.
double signedDistance(const VoxelVolume& volume, int i, int j, int k, const Eigen::Vector3d& center,
                      double radius) {
    const double sag = volume.spacing().squaredNorm() / (8 * radius);
    return (positionOf(volume, i, j, k) - center).norm() - (radius + sag);
}
double slopeOf(const VoxelVolume& volume) {
    const double iso = volume.iso();
    return std::min(iso, kMaxDensity - iso) / volume.spacing().maxCoeff();
}
double limitAt(const VoxelVolume& volume, double d, int direction) {
    const bool is_far = d >= BurrLimit::kMaxReach * volume.spacing().maxCoeff();
    if (is_far) return direction < 0 ? kMaxDensity : 0;
    return std::clamp(volume.iso() - direction * slopeOf(volume) * d, 0.0, double(kMaxDensity));
}

// These are the largest distances from the sphere of the drawn surface's vertices and of the shell's points,
// among those nearer to it than three voxels; and the farthest that any of them is inside.
struct Offset {
    double mesh = 0, shell = 0, inside = 0;
    size_t vertices = 0, points = 0;
};
Offset offsetFromSphere(const BoneModel& bone, const Eigen::Vector3d& center, double radius) {
    Offset offset;
    const double near = 3 * bone.volume.spacing().maxCoeff();
    const auto see = [&](const Eigen::Vector3d& p, double& largest, size_t& count) {
        const double off = (p - center).norm() - radius;
        if (std::abs(off) > near) return;
        largest = std::max(largest, std::abs(off));
        offset.inside = std::max(offset.inside, -off);
        ++count;
    };
    const MeshGrid grid(bone.volume, bone.lattice);
    for (const NodeMesh& mesh : test::meshAll(bone.volume, bone.lattice))
        for (const PackedVertex& v : mesh.vertices)
            see(grid.position(grid.stepsOf(mesh.leaf, v)), offset.mesh, offset.vertices);
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& b, uint32_t count) {
            for (uint32_t i = 0; i < count; ++i)
                see(Eigen::Vector3d(b.x[i], b.y[i], b.z[i]), offset.shell, offset.points);
        });
    return offset;
}

class SubVoxelSphere : public testing::TestWithParam<int> {};  // radius in voxels

// The sag of the interpolated distance is 0 .. h²/(4 R) in a cell (0 .. h²/(8 R) on an edge), and the ramp is
// that of a sphere larger by 3h²/(8 R): the surface ends up to that much outside, never inside. Where the
// ramp ends inside a cell half a percent of a voxel comes on top. For the usual burr, 8 voxels in radius,
// this is 5 % of a voxel.
TEST_P(SubVoxelSphere, DwellingLeavesTheSphere) {
    const double radius = GetParam() * kFineVoxel;
    for (const Eigen::Vector3d& spacing : kSpacings)
        for (const Density iso : kIsos)
            for (const int direction : {-1, +1}) {
                const double side = 2 * radius + 9 * kFineVoxel;
                BoneModel bone = cube(side, spacing, iso, direction < 0 ? kMaxDensity : 0);
                TimedMilling milling(atOnce(), bone.volume, bone.lattice, radius);
                const Eigen::Vector3d center =
                    Eigen::Vector3d::Constant(side / 2) + Eigen::Vector3d(0.31, -0.17, 0.44) * kFineVoxel;
                for (int n = 0; n < 2; ++n)
                    milling.apply(bone.volume, bone.lattice, bone.shell, center, direction, kTickTime);
                const Offset offset = offsetFromSphere(bone, center, radius);
                EXPECT_GT(offset.vertices, 500u);
                EXPECT_GT(offset.points, 500u);
                const double bound = 3 / (8.0 * GetParam());
                EXPECT_LT(offset.mesh / kFineVoxel, bound + 1e-3) << "iso " << iso;
                EXPECT_LT(offset.shell / kFineVoxel, bound + 5e-3) << "iso " << iso;
            }
}

INSTANTIATE_TEST_SUITE_P(Radii, SubVoxelSphere, testing::Values(8, 13));

// The surface of the cavity that a burr leaves in full bone, in voxels: how far it reaches into the burr at
// most.
double reachIntoBurr(double radius_in_voxels, const Eigen::Vector3d& spacing, Density iso, uint32_t place) {
    const double voxel = spacing.maxCoeff(), radius = radius_in_voxels * voxel;
    const double side = 2 * radius + 9 * voxel;
    BoneModel bone = cube(side, spacing, iso, kMaxDensity);
    TimedMilling milling(atOnce(), bone.volume, bone.lattice, radius);
    std::mt19937 random(place);
    std::uniform_real_distribution<double> in_voxel(-0.5, 0.5);
    Eigen::Vector3d center;
    for (int axis = 0; axis < 3; ++axis) center[axis] = side / 2 + in_voxel(random) * spacing[axis];
    for (int n = 0; n < 2; ++n) milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kTickTime);
    const Offset offset = offsetFromSphere(bone, center, radius);
    EXPECT_GT(offset.vertices, 0u);
    EXPECT_GT(offset.points, 0u);
    return offset.inside / voxel;
}

// Cells as large as the burr and larger have the surface where their corners put it: also then not inside of
// the burr, where it would hold the burr up for good.
TEST(SubVoxelMilling, LeavesNoBoneInABurrOfAnySize) {
    const std::vector<Eigen::Vector3d> spacings = {
        {1e-3, 1e-3, 1e-3}, {0.4e-3, 0.4e-3, 1.2e-3}, {0.957e-3, 0.957e-3, 1.5e-3}};
    for (const Eigen::Vector3d& spacing : spacings)
        for (const Density iso : kIsos)
            for (const double radius_in_voxels : {0.3, 0.5, 1.0, 1.5, 2.0, 3.0})
                for (uint32_t place = 0; place < 4; ++place)
                    EXPECT_LT(reachIntoBurr(radius_in_voxels, spacing, iso, place), 0.01)
                        << "R/h " << radius_in_voxels << ", iso " << iso << ", spacing "
                        << spacing.transpose();
}

TEST(SubVoxelMilling, EveryVoxelEndsAtItsLimitAndNoneElsewhereChanges) {
    std::mt19937 random(2);
    std::uniform_int_distribution<int> density(0, kMaxDensity);
    for (const Eigen::Vector3d& spacing : kSpacings)
        for (const Density iso : kIsos)
            for (const int direction : {-1, +1}) {
                BoneModel bone = filled({31, 33, 29}, spacing, iso, 0);
                const IndexBox all = test::wholeBox(bone.volume);
                test::writeLikeTick(bone.volume, bone.lattice, all,
                                    [&](int, int, int) { return Density(density(random)); });
                bone.shell.refresh(bone.volume, bone.lattice, {&all, 1});
                const VoxelVolume before = bone.volume;
                const double radius = 6.3 * kFineVoxel;
                const Eigen::Vector3d center(12.2173 * kFineVoxel, 14.7391 * kFineVoxel,
                                             11.4257 * kFineVoxel);
                TimedMilling milling(atOnce(), bone.volume, bone.lattice, radius);
                const MillingResult result =
                    milling.apply(bone.volume, bone.lattice, bone.shell, center, direction, kTickTime);
                uint32_t crossed = 0;
                test::forEachVoxel(all, [&](int i, int j, int k) {
                    const double old = before.at(i, j, k);
                    const double limit =
                        limitAt(before, signedDistance(before, i, j, k, center, radius), direction);
                    const double expected = direction < 0 ? std::min(old, limit) : std::max(old, limit);
                    const double now = bone.volume.at(i, j, k);
                    ASSERT_NEAR(now, expected, 0.6) << i << ' ' << j << ' ' << k;
                    crossed += (old >= iso) != (now >= iso);
                });
                EXPECT_EQ(direction < 0 ? result.removed_voxels : result.added_voxels, crossed);
                EXPECT_EQ(direction < 0 ? result.added_voxels : result.removed_voxels, 0u);
            }
}

// The ramp of densities moves on by the burr's speed of removal.
TEST(SubVoxelMilling, NoVoxelLosesMoreThanTheSpeedAllows) {
    BoneModel bone = cube(4e-3, kSpacings[0], 32768, kMaxDensity);
    MillingConfig config = atOnce();
    config.removal_rate = 100'003.7;
    const double radius = 1e-3;
    const Eigen::Vector3d center(2e-3, 2.01e-3, 1.97e-3);
    TimedMilling milling(config, bone.volume, bone.lattice, radius);
    EXPECT_NEAR(milling.removalSpeed(), 2 * radius * config.removal_rate / kMaxDensity, 1e-12);
    for (int n = 1; n <= 100; ++n) {
        milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kTickTime);
        const double lost = slopeOf(bone.volume) * milling.removalSpeed() * n * kTickTime;
        test::forEachVoxel(test::wholeBox(bone.volume), [&](int i, int j, int k) {
            const double limit =
                limitAt(bone.volume, signedDistance(bone.volume, i, j, k, center, radius), -1);
            ASSERT_NEAR(bone.volume.at(i, j, k), std::max(limit, kMaxDensity - lost), 1.51);
        });
    }
}

// Returns the height at which the burr's centre stands on the bone when the contact lets it sink
// in by `sunk`.
double heightOnBone(const BoneModel& bone, const Eigen::Vector2d& xy, double radius, double sunk) {
    double height = -INFINITY;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& b, uint32_t count) {
            for (uint32_t i = 0; i < count; ++i) {
                const double aside = (Eigen::Vector2d(b.x[i], b.y[i]) - xy).norm();
                if (aside >= radius - sunk) continue;
                height =
                    std::max(height, double(b.z[i]) + std::sqrt(std::pow(radius - sunk, 2) - aside * aside));
            }
        });
    return height;
}

// A stiff contact lets the burr sink in by micrometres only: below the next layer of voxel centres it never
// comes unless milling goes below the voxel size.
TEST(SubVoxelMilling, ABurrSunkByMicrometresGoesOnCutting) {
    const double radius = 1e-3;
    const double sunk = 3e-6;
    constexpr int kTicks = 150;
    const auto feed_with = [&](MillingShape shape) {
        VoxelVolume volume = test::bodyVolume(test::cubeGeometry(33, kFineVoxel),
                                              test::halfSpace({0, 0, 2.03e-3}, Eigen::Vector3d::UnitZ()));
        BoneModel bone(std::move(volume), Eigen::Vector3i::Constant(16), ShellConfig{});
        TimedMilling milling({.removal_rate = kInTwentyTicks, .shape = shape}, bone.volume, bone.lattice,
                             radius);
        const Eigen::Vector2d xy(2.02e-3, 2.05e-3);
        const double start = heightOnBone(bone, xy, radius, sunk);
        double height = start;
        for (int n = 0; n < kTicks; ++n) {
            milling.apply(bone.volume, bone.lattice, bone.shell, {xy.x(), xy.y(), height}, -1, kTickTime);
            height = heightOnBone(bone, xy, radius, sunk);
        }
        return start - height;
    };
    EXPECT_LT(feed_with(MillingShape::kVoxelCentres), kFineVoxel);
    const double feed = feed_with(MillingShape::kSubVoxel);
    EXPECT_GT(feed, 0.5 * kTicks * sunk);
    EXPECT_LT(feed, 2 * kTicks * sunk);  // each tick also clears the ample sag's few µm
}

TEST(SubVoxelMilling, APassLeavesTheSweptCapsule) {
    for (const Eigen::Vector3d& spacing : kSpacings) {
        BoneModel bone = cube(5e-3, spacing, 26214, kMaxDensity);
        const double before = test::boneVolume(bone);
        const double radius = 1e-3;
        const Eigen::Vector3d start(1.52e-3, 1.61e-3, 1.57e-3);
        const Eigen::Vector3d end(3.41e-3, 3.12e-3, 3.44e-3);
        TimedMilling milling({.removal_rate = kInTwentyTicks, .shape = MillingShape::kSubVoxel}, bone.volume,
                             bone.lattice, radius);
        constexpr int kSteps = 600;
        constexpr int kDwell = 30;  // at both ends, longer than a full voxel takes to go
        for (int n = 0; n < kSteps + 2 * kDwell; ++n) {
            const double way = std::clamp((n - kDwell) / double(kSteps), 0.0, 1.0);
            milling.apply(bone.volume, bone.lattice, bone.shell, start + way * (end - start), -1, kTickTime);
        }
        const double swept =
            M_PI * radius * radius * (end - start).norm() + 4.0 / 3 * M_PI * std::pow(radius, 3);
        EXPECT_NEAR((before - test::boneVolume(bone)) / swept, 1, 0.01) << spacing.transpose();
    }
}

// However far the burr goes in a tick, nothing is left between where it sets out and where it ends.
TEST(SubVoxelMilling, OneTickLeavesWhatManyDo) {
    const double radius = 0.6e-3;
    const Eigen::Vector3d start(1.02e-3, 1.11e-3, 1.07e-3), end(3.31e-3, 2.6e-3, 2.94e-3);
    for (const Eigen::Vector3d& spacing : kSpacings)
        for (const int direction : {-1, +1}) {
            const Density before = direction < 0 ? kMaxDensity : 0;
            BoneModel once = cube(4.4e-3, spacing, 26214, before),
                      often = cube(4.4e-3, spacing, 26214, before);
            MillingConfig config = atOnce();
            config.longest_way = (end - start).norm();
            TimedMilling in_one(config, once.volume, once.lattice, radius);
            TimedMilling in_many(config, often.volume, often.lattice, radius);
            in_one.apply(once.volume, once.lattice, once.shell, BurrWay(start, end, config.longest_way),
                         direction, kTickTime);
            constexpr int kSteps = 400;
            for (int n = 0; n <= kSteps; ++n)
                in_many.apply(often.volume, often.lattice, often.shell,
                              start + double(n) / kSteps * (end - start), direction, kTickTime);
            test::forEachVoxel(test::wholeBox(once.volume), [&](int i, int j, int k) {
                ASSERT_NEAR(once.volume.at(i, j, k), often.volume.at(i, j, k), 8)
                    << i << ' ' << j << ' ' << k;
            });
        }
}

TEST(SubVoxelMilling, ABurrAwayFromTheBoneTouchesNothing) {
    BoneModel bone = cube(4e-3, kSpacings[1], 26214, kMaxDensity);
    const double radius = 1e-3;
    TimedMilling milling(atOnce(), bone.volume, bone.lattice, radius);
    const double away = radius + (1 + (65535 - 26214) / 26214.0) * kFineVoxel;
    for (const Eigen::Vector3d& center :
         {Eigen::Vector3d(-away, 2e-3, 2e-3), Eigen::Vector3d(2e-3, 4.2e-3 + away, 2e-3),
          Eigen::Vector3d(1e6, -1e6, 0), Eigen::Vector3d(-5e8, 5e8, 5e8)}) {
        const MillingResult result =
            milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kTickTime);
        EXPECT_TRUE(result.changed.isEmpty());
    }
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf) EXPECT_EQ(bone.lattice.version(leaf), 0u);
}

TEST(SubVoxelMilling, WhatIsAtItsLimitMarksNoLeaf) {
    BoneModel bone = cube(4e-3, kSpacings[1], 26214, kMaxDensity);
    TimedMilling milling(atOnce(), bone.volume, bone.lattice, 1e-3);
    const Eigen::Vector3d center(2e-3, 2e-3, 2e-3);
    EXPECT_FALSE(
        milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kTickTime).changed.isEmpty());
    EXPECT_TRUE(
        milling.apply(bone.volume, bone.lattice, bone.shell, center, -1, kTickTime).changed.isEmpty());
}

// The shape is switched between ticks, in both directions, also at the volume's border.
TEST(SubVoxelMilling, ShellAndRangesFollowWhateverTheShape) {
    BoneModel bone = cube(4e-3, kSpacings[1], 26214, kMaxDensity);
    TimedMilling milling({.removal_rate = 9e6, .addition_rate = 9e6}, bone.volume, bone.lattice, 0.7e-3);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> where(-0.3e-3, 4.3e-3);
    for (int stroke = 0; stroke < 30; ++stroke) {
        milling.setShape(stroke % 3 ? MillingShape::kSubVoxel : MillingShape::kVoxelCentres);
        const Eigen::Vector3d center(where(random), where(random), where(random));
        for (int n = 0; n < 8; ++n)
            EXPECT_TRUE(milling
                            .apply(bone.volume, bone.lattice, bone.shell,
                                   center + n * 13e-6 * Eigen::Vector3d::UnitX(), stroke % 4 ? -1 : +1,
                                   kTickTime)
                            .shell_is_complete);
        const LeafLattice lattice(bone.volume, bone.lattice.leafCells());
        const PointShell shell(bone.volume, lattice, {.levels = {{1}, {2}, {3}}, .spare_points = 0});
        for (int level = 0; level < lattice.levelCount(); ++level)
            for (uint32_t node = 0; node < lattice.nodeCount(level); ++node) {
                ASSERT_EQ(bone.lattice.range(level, node).min, lattice.range(level, node).min);
                ASSERT_EQ(bone.lattice.range(level, node).max, lattice.range(level, node).max);
            }
        for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
            for (int level = 0; level < 3; ++level) {
                bone.shell.prepare(bone.volume, bone.lattice, level, int(lattice.leafCount()));
                std::vector<float> a, b;
                const auto gather = [](std::vector<float>& out) {
                    return [&out](const ShellBlock& block, uint32_t count) {
                        for (uint32_t i = 0; i < count; ++i)
                            for (const float value : {block.x[i], block.y[i], block.z[i], block.nx[i],
                                                      block.ny[i], block.nz[i], block.area[i]})
                                out.push_back(value);
                    };
                };
                bone.shell.forEachBlock(level, leaf, gather(a));
                shell.forEachBlock(level, leaf, gather(b));
                ASSERT_EQ(a, b) << "leaf " << leaf << " level " << level;
            }
        }
    }
}

}  // namespace
}  // namespace bonemill
