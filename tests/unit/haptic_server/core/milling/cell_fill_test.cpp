#include "haptic_server/core/milling/cell_fill.h"

#include <gtest/gtest.h>

#include <functional>

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/contact/cell_indices.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

double filled(const VoxelVolume& volume) {
    CellIndices cells(size_t((volume.dims().array() + 1).prod()));
    forEachIndex({Eigen::Vector3i::Constant(-1), volume.dims().array() - 1},
                 [&](const Eigen::Vector3i& cell) { cells.add(cell); });
    std::vector<float> shares(cells.count() + kCellLanes);
    std::vector<int> inside(shares.size());
    CellFills().measure(volume, cells.list(), shares.data(), inside.data());
    double sum = 0;
    for (size_t n = 0; n < cells.count(); ++n) {
        sum += double(shares[n]);
        EXPECT_EQ(inside[n], readCorners(volume, cells[n]).inside());
    }
    return sum * volume.voxelVolume();
}

// Of the cell whose corners have these densities above iso.
double fillOf(const std::function<double(const Eigen::Vector3d&)>& excess) {
    VoxelVolume volume(test::boxGeometry({2, 2, 2}), 32768);
    test::forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        volume.set(i, j, k, Density(volume.iso() + excess({double(i), double(j), double(k)})));
    });
    CellIndices cells(1);
    cells.add({0, 0, 0});
    float share[1 + kCellLanes];
    int inside[1 + kCellLanes];
    CellFills().measure(volume, cells.list(), share, inside);
    return double(share[0]);
}

// This holds whatever the densities: all 256 kinds of cells occur, with every kind of neighbour.
TEST(CellFill, AddsUpToTheVolumeOfTheDrawnSurface) {
    std::mt19937 random(3);
    for (const bool is_noise : {true, false})
        for (int n = 0; n < 3; ++n) {
            VoxelVolume volume(test::boxGeometry({19, 23, 17}), 32768);
            is_noise ? test::fillNoise(volume, random) : test::fillWaves(volume, random);
            const LeafLattice lattice(volume, {16, 16, 16});
            const auto meshes = test::meshAll(volume, lattice);
            const double drawn = meshVolume(meshes, MeshGrid(volume, lattice));
            ASSERT_GT(drawn, 0);
            // The drawn vertices lie on whole steps of their edges.
            EXPECT_NEAR(filled(volume) / drawn, 1, is_noise ? 3e-3 : 1e-4);
        }
}

TEST(CellFill, IsTheShareBelowAPlane) {
    for (const double height : {0.0625, 0.25, 0.5, 0.875}) {
        const double flat = fillOf([&](const Eigen::Vector3d& at) { return 16000 * (height - at.z()); });
        EXPECT_NEAR(flat, height, 1e-6);
        const double slanted =
            fillOf([&](const Eigen::Vector3d& at) { return 16000 * (height - (at.x() + at.z()) / 2); });
        const double corner = height <= 0.5 ? 2 * height * height : 1 - 2 * (1 - height) * (1 - height);
        EXPECT_NEAR(slanted, corner, 1e-6);
    }
}

}  // namespace
}  // namespace bonemill
