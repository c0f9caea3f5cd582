#include "haptic_server/core/milling/cell_fill.h"

#include <gtest/gtest.h>

#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

double fillOf(const CellCorners& corners) {
    CellFills fills;
    fills.add(corners, corners.inside());
    double result = 0;
    fills.take([&](int, float fill) { result = double(fill); });
    return result;
}

double filled(const VoxelVolume& volume) {
    CellFills fills;
    double sum = 0;
    const auto take = [&] { fills.take([&](int, float fill) { sum += double(fill); }); };
    forEachIndex({Eigen::Vector3i::Constant(-1), volume.dims().array() - 1},
                 [&](const Eigen::Vector3i& cell) {
                     const CellCorners corners = readCorners(volume, cell);
                     fills.add(corners, corners.inside());
                     if (fills.isFull()) take();
                 });
    take();
    return sum * volume.voxelVolume();
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
        CellCorners flat, slanted;
        for (unsigned c = 0; c < 8; ++c) {
            const double x = c & 1, z = c >> 2 & 1;
            flat.excess[c] = float(1000 * (height - z));
            slanted.excess[c] = float(1000 * (height - (x + z) / 2));
        }
        EXPECT_NEAR(fillOf(flat), height, 1e-6);
        const double corner = height <= 0.5 ? 2 * height * height : 1 - 2 * (1 - height) * (1 - height);
        EXPECT_NEAR(fillOf(slanted), corner, 1e-6);
    }
}

}  // namespace
}  // namespace bonemill
