#include "haptic_server/core/volume/leaf_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using test::boxGeometry;
using test::forEachVoxel;

constexpr Density kLatticeIso = 30000;
const std::vector<Eigen::Vector3i> kLeafSizes = {{4, 4, 4}, {5, 3, 7}, {1, 1, 1}, {16, 16, 16}, {100, 2, 9}};

VoxelVolume waves(unsigned seed = 1, const Eigen::Vector3i& dims = {17, 22, 13}) {
    VoxelVolume volume(boxGeometry(dims), kLatticeIso);
    std::mt19937 random(seed);
    test::fillWaves(volume, random);
    return volume;
}

void expectSameRanges(const LeafLattice& a, const LeafLattice& b) {
    ASSERT_EQ(a.levelCount(), b.levelCount());
    Eigen::Vector3i nodes = a.leavesPerAxis();
    for (int level = 0; level < a.levelCount(); ++level) {
        for (uint32_t node = 0; node < uint32_t(nodes.prod()); ++node) {
            EXPECT_EQ(a.range(level, node).min, b.range(level, node).min)
                << "level " << level << " node " << node;
            EXPECT_EQ(a.range(level, node).max, b.range(level, node).max)
                << "level " << level << " node " << node;
        }
        nodes = (nodes.array() + 1) / 2;
    }
}

TEST(LeafLattice, LeavesPartitionTheCells) {
    const VoxelVolume volume = waves();
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        const LeafLattice lattice(volume, leaf_cells);
        std::set<std::array<int, 3>> seen;
        size_t cells = 0;
        for (LeafId id = 0; id < lattice.leafCount(); ++id) {
            EXPECT_EQ(lattice.leafId(lattice.leafIndex(id)), id);
            forEachVoxel(lattice.cellsOf(id), [&](int i, int j, int k) {
                seen.insert({i, j, k});
                ++cells;
                const IndexBox owner = lattice.leavesOfCells({{i, j, k}, {i, j, k}});
                EXPECT_EQ(owner.min, lattice.leafIndex(id));
                EXPECT_EQ(owner.max, lattice.leafIndex(id));
            });
        }
        EXPECT_EQ(cells, 18u * 23 * 14);
        EXPECT_EQ(seen.size(), cells);
    }
}

TEST(LeafLattice, DepthGivesAtMostThatManyLeavesPerAxis) {
    const VolumeGeometry tooth = boxGeometry({256, 256, 161});
    EXPECT_EQ(LeafLattice::leafCellsOfDepth(tooth, 3), Eigen::Vector3i(33, 33, 21));
    const VoxelVolume volume = waves();
    for (int depth = 0; depth < 6; ++depth) {
        const LeafLattice lattice(volume, LeafLattice::leafCellsOfDepth(volume.geometry(), depth));
        EXPECT_LE(lattice.leavesPerAxis().maxCoeff(), 1 << depth);
        EXPECT_LE(lattice.levelCount(), depth + 1);
    }
}

TEST(LeafLattice, LeafRangesHoldTheirVoxelsAndParentsTheirChildren) {
    const VoxelVolume volume = waves();
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        const LeafLattice lattice(volume, leaf_cells);
        const auto extremesOf = [&](const IndexBox& cells) {
            DensityRange range;
            forEachVoxel({cells.min, cells.max + Eigen::Vector3i::Ones()}, [&](int i, int j, int k) {
                range.min = std::min(range.min, volume.at(i, j, k));
                range.max = std::max(range.max, volume.at(i, j, k));
            });
            return range;
        };
        for (LeafId id = 0; id < lattice.leafCount(); ++id) {
            const DensityRange expected = extremesOf(lattice.cellsOf(id));
            EXPECT_EQ(lattice.range(0, id).min, expected.min);
            EXPECT_EQ(lattice.range(0, id).max, expected.max);
            EXPECT_EQ(lattice.mayHoldSurface(id, kLatticeIso),
                      expected.min < kLatticeIso && expected.max >= kLatticeIso);
        }
        const DensityRange all =
            extremesOf({Eigen::Vector3i::Constant(-1), volume.dims() - Eigen::Vector3i::Ones()});
        const DensityRange& root = lattice.range(lattice.levelCount() - 1, 0);
        EXPECT_EQ(root.min, all.min);
        EXPECT_EQ(root.max, all.max);
    }
}

TEST(LeafLattice, RefreshedRangesEqualAFullScan) {
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        VoxelVolume volume = waves(2);
        LeafLattice lattice(volume, leaf_cells);
        std::mt19937 random(5);
        std::uniform_int_distribution<int> density(0, kMaxDensity);
        for (int edit = 0; edit < 60; ++edit) {
            test::writeLikeTick(volume, lattice, test::randomBox(volume, 5, random),
                                [&](int, int, int) { return Density(density(random)); });
            if (edit % 10 == 0) expectSameRanges(lattice, LeafLattice(volume, leaf_cells));
        }
        expectSameRanges(lattice, LeafLattice(volume, leaf_cells));
    }
}

// The distinct densities are few: extremes lie inside and outside the change, the two beside the sign bit
// among them.
TEST(LeafLattice, RefreshedRangesEqualAFullScanWithTies) {
    constexpr Density kValues[] = {0, 1, 32767, 32768, 65534, kMaxDensity};
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        std::mt19937 random(6);
        std::uniform_int_distribution<int> lowest(0, 5);
        VoxelVolume volume(boxGeometry({17, 12, 13}), kLatticeIso);
        LeafLattice lattice(volume, leaf_cells);
        for (int edit = 0; edit < 150; ++edit) {
            std::uniform_int_distribution<int> value(lowest(random), 5);
            test::writeLikeTick(volume, lattice, test::randomBox(volume, 9, random),
                                [&](int, int, int) { return kValues[value(random)]; });
            expectSameRanges(lattice, LeafLattice(volume, leaf_cells));
        }
    }
}

TEST(LeafLattice, RefreshNarrowsRangesAgain) {
    VoxelVolume volume(boxGeometry({20, 20, 20}), kLatticeIso);
    LeafLattice lattice(volume, {4, 4, 4});
    const IndexBox box{{7, 7, 7}, {7, 7, 7}};
    test::writeLikeTick(volume, lattice, box, [](int, int, int) { return kMaxDensity; });
    EXPECT_EQ(lattice.range(lattice.levelCount() - 1, 0).max, kMaxDensity);
    test::writeLikeTick(volume, lattice, box, [](int, int, int) { return Density(0); });
    EXPECT_EQ(lattice.range(lattice.levelCount() - 1, 0).max, 0);
}

TEST(LeafLattice, VersionsAreOddOnlyDuringTheWrite) {
    const VoxelVolume volume = waves();
    LeafLattice lattice(volume, {4, 4, 4});
    const IndexBox box{{5, 6, 7}, {6, 6, 7}};
    for (LeafId id = 0; id < lattice.leafCount(); ++id) EXPECT_EQ(lattice.version(id), 0u);
    lattice.beginWrite(box);
    std::set<LeafId> odd;
    for (LeafId id = 0; id < lattice.leafCount(); ++id)
        if (lattice.version(id) == 1) odd.insert(id);
    lattice.endWrite(box);
    EXPECT_FALSE(odd.empty());
    for (LeafId id = 0; id < lattice.leafCount(); ++id)
        EXPECT_EQ(lattice.version(id), odd.contains(id) ? 2u : 0u);
}

// A single voxel's change moves the version of every leaf whose mesh it can change, and of no leaf
// farther away.
TEST(LeafLattice, WriteReachesExactlyTheLeavesWithinItsInfluence) {
    const VoxelVolume volume = waves();
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        std::mt19937 random(8);
        for (int n = 0; n < 30; ++n) {
            const IndexBox voxel = test::randomBox(volume, 1, random);
            LeafLattice lattice(volume, leaf_cells);
            lattice.beginWrite(voxel);
            lattice.endWrite(voxel);
            for (LeafId id = 0; id < lattice.leafCount(); ++id) {
                const IndexBox cells = lattice.cellsOf(id);
                // The leaf's mesh depends on the corners of its cells, and on one more voxel for the gradient
                // at the corners.
                const Eigen::Array3i first = cells.min.array() - 1;
                const Eigen::Array3i last = cells.max.array() + 2;
                const bool is_near = (voxel.min.array() >= first).all() && (voxel.min.array() <= last).all();
                EXPECT_EQ(lattice.version(id), is_near ? 2u : 0u)
                    << "leaf " << id << " voxel " << voxel.min.transpose();
            }
        }
    }
}

TEST(LeafLattice, WritesOutsideTheVolumeAreHarmless) {
    const VoxelVolume volume = waves();
    LeafLattice lattice(volume, {4, 4, 4});
    const LeafLattice untouched(volume, {4, 4, 4});
    for (const IndexBox& box :
         {IndexBox{{-50, 0, 0}, {-40, 5, 5}}, IndexBox{{100, 100, 100}, {120, 120, 120}}, IndexBox{}}) {
        lattice.beginWrite(box);
        lattice.refreshRanges(volume, box);
        lattice.endWrite(box);
    }
    expectSameRanges(lattice, untouched);
    for (LeafId id = 0; id < lattice.leafCount(); ++id) EXPECT_EQ(lattice.version(id) % 2, 0u);
}

// By brute force, a leaf is wanted when its box of cells meets the box in space and its range holds iso.
std::vector<LeafId> surfaceLeavesByBruteForce(const LeafLattice& lattice, const VoxelVolume& volume,
                                              const Eigen::AlignedBox3d& box) {
    std::vector<LeafId> wanted;
    for (LeafId id = 0; id < lattice.leafCount(); ++id) {
        const IndexBox cells = lattice.cellsOf(id);
        const Eigen::Array3d low = cells.min.cast<double>().cwiseProduct(volume.spacing()).array();
        const Eigen::Array3d high =
            (cells.max + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(volume.spacing()).array();
        // The cells are half-open: a box that only touches a leaf's high side belongs to the next leaf.
        const bool meets = (box.min().array() < high).all() && (box.max().array() >= low).all();
        if (meets && lattice.mayHoldSurface(id, kLatticeIso)) wanted.push_back(id);
    }
    return wanted;
}

TEST(LeafLattice, SurfaceLeavesInABoxEqualBruteForce) {
    const VoxelVolume volume = waves(3);
    const Eigen::Vector3d extent = volume.spacing().cwiseProduct(volume.dims().cast<double>());
    std::mt19937 random(2);
    std::uniform_real_distribution<double> inside(-0.4, 1.4), size(0.0, 0.5);
    size_t found_in_all = 0;
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        const LeafLattice lattice(volume, leaf_cells);
        for (int n = 0; n < 200; ++n) {
            const Eigen::Vector3d low(inside(random) * extent.x(), inside(random) * extent.y(),
                                      inside(random) * extent.z());
            const Eigen::AlignedBox3d box(low, low + size(random) * extent);
            std::vector<LeafId> found;
            lattice.forEachSurfaceLeaf(box, volume.spacing(), kLatticeIso,
                                       [&](LeafId id) { found.push_back(id); });
            std::sort(found.begin(), found.end());
            EXPECT_EQ(found, surfaceLeavesByBruteForce(lattice, volume, box));
            found_in_all += found.size();
        }
    }
    EXPECT_GT(found_in_all, 1000u);
}

TEST(LeafLattice, BoxesFarAwayOrHugeAreSafe) {
    const VoxelVolume volume = waves();
    const LeafLattice lattice(volume, {4, 4, 4});
    const auto countIn = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
        size_t count = 0;
        lattice.forEachSurfaceLeaf({low, high}, volume.spacing(), kLatticeIso, [&](LeafId) { ++count; });
        return count;
    };
    EXPECT_EQ(countIn(Eigen::Vector3d::Constant(1e9), Eigen::Vector3d::Constant(1e9 + 1)), 0u);
    EXPECT_EQ(countIn(Eigen::Vector3d::Constant(-1e9), Eigen::Vector3d::Constant(-1e9 + 1)), 0u);
    size_t all = 0;
    for (LeafId id = 0; id < lattice.leafCount(); ++id)
        all += lattice.mayHoldSurface(id, kLatticeIso) ? 1 : 0;
    EXPECT_EQ(countIn(Eigen::Vector3d::Constant(-1e9), Eigen::Vector3d::Constant(1e9)), all);
}

}  // namespace
}  // namespace bonemill
