#include <gtest/gtest.h>

#include <random>

#include "haptic_server/lab/accuracy_report/truth.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

VoxelVolume noiseVolume() {
    VolumeGeometry geometry;
    geometry.dims = {7, 6, 5};
    geometry.spacing = {0.3e-3, 0.4e-3, 0.5e-3};
    geometry.X_WV = {{0.01, -0.02, 0.03}, expRotation({0.3, -0.4, 0.5})};
    VoxelVolume volume(geometry, 30000);
    std::mt19937 random(7);
    std::uniform_int_distribution<int> density(0, kMaxDensity);
    for (int k = 0; k < 5; ++k)
        for (int j = 0; j < 6; ++j)
            for (int i = 0; i < 7; ++i) volume.set(i, j, k, Density(density(random)));
    return volume;
}

// Weights eight corners, the slow way.
double trilinear(const VoxelVolume& volume, const Vector3d& p_V) {
    const Vector3d index = p_V.cwiseQuotient(volume.spacing());
    const Eigen::Vector3i cell = index.array().floor().cast<int>();
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        Eigen::Vector3i voxel = cell;
        for (int axis = 0; axis < 3; ++axis) {
            const double f = index[axis] - cell[axis];
            const bool upper = corner >> axis & 1;
            weight *= upper ? f : 1 - f;
            voxel[axis] += upper;
        }
        if (weight > 0) sum += weight * volume.at(voxel.x(), voxel.y(), voxel.z());
    }
    return sum;
}

void expectSameField(const VoxelVolume& coarse, const VoxelVolume& fine) {
    const Pose X_VF = coarse.geometry().X_WV.inverse() * fine.geometry().X_WV;
    for (int k = 0; k < fine.dims().z(); ++k)
        for (int j = 0; j < fine.dims().y(); ++j)
            for (int i = 0; i < fine.dims().x(); ++i) {
                Vector3d p_V = X_VF * fine.spacing().cwiseProduct(Vector3d(i, j, k));
                // A place that lies on the coarse lattice but for rounding is put onto it.
                const Vector3d index = p_V.cwiseQuotient(coarse.spacing());
                for (int axis = 0; axis < 3; ++axis)
                    if (std::abs(index[axis] - std::round(index[axis])) < 1e-9)
                        p_V[axis] = std::round(index[axis]) * coarse.spacing()[axis];
                ASSERT_NEAR(fine.at(i, j, k), trilinear(coarse, p_V), 0.51) << i << ' ' << j << ' ' << k;
            }
}

TEST(RefinedPart, HasTheTrilinearDensityAtTheSamePlaces) {
    const VoxelVolume coarse = noiseVolume();
    for (const int times : {1, 2, 4}) {
        const IndexBox box{{1, 2, 0}, {5, 4, 3}};
        const VoxelVolume fine = refinedPart(coarse, box, times);
        EXPECT_EQ(fine.dims(), Eigen::Vector3i(4 * times + 1, 2 * times + 1, 3 * times + 1));
        EXPECT_EQ(fine.iso(), coarse.iso());
        EXPECT_EQ(refinedCount(box, times), size_t(fine.dims().prod()));
        expectSameField(coarse, fine);
    }
}

TEST(RefinedPart, ReachesIntoTheBorderOfAir) {
    const VoxelVolume coarse = noiseVolume();
    const VoxelVolume fine = refinedPart(coarse, {{-1, -1, -1}, coarse.dims()}, 3);
    EXPECT_EQ(fine.at(0, 0, 0), 0);
    expectSameField(coarse, fine);
}

TEST(RefinedPart, AreaOfABallsSurfaceStays) {
    const auto coarse =
        test::bodyVolume(test::cubeGeometry(24, 0.2e-3), test::sphereAt(Vector3d::Constant(2.3e-3), 1.5e-3));
    const auto areaOf = [](VoxelVolume volume) {
        const BoneModel bone(std::move(volume), Eigen::Vector3i::Constant(16), ShellConfig{});
        double area = 0;
        for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
            bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& block, uint32_t count) {
                for (uint32_t i = 0; i < count; ++i) area += double(block.area[i]);
            });
        return area;
    };
    const double fine = areaOf(refinedPart(coarse, {{-1, -1, -1}, coarse.dims()}, 4));
    EXPECT_NEAR(fine / areaOf(VoxelVolume(coarse)), 1, 5e-3);
    EXPECT_NEAR(fine / (4 * M_PI * 1.5e-3 * 1.5e-3), 1, 5e-3);
}

TEST(AffordableRefinement, IsTheLargestThatFits) {
    const IndexBox box{{0, 0, 0}, {10, 10, 10}};
    EXPECT_EQ(affordableRefinement(box, 4, size_t(41) * 41 * 41), 4);
    EXPECT_EQ(affordableRefinement(box, 4, size_t(41) * 41 * 41 - 1), 3);
    EXPECT_EQ(affordableRefinement(box, 4, 0), 1);
}

TEST(VoxelsAround, GrowsAndIsCutToWhatCanBeRead) {
    const VoxelVolume volume(test::cubeGeometry(10, 1e-3), test::kTestIso);
    const IndexBox inside =
        voxelsAround(volume, {Vector3d(4.1e-3, 4.1e-3, 4.1e-3), Vector3d(5.2e-3, 5.2e-3, 5.2e-3)}, 1e-3);
    EXPECT_EQ(inside.min, Eigen::Vector3i::Constant(3));
    EXPECT_EQ(inside.max, Eigen::Vector3i::Constant(7));
    const IndexBox cut = voxelsAround(volume, {Vector3d::Constant(-1), Vector3d::Constant(1)}, 0);
    EXPECT_EQ(cut.min, Eigen::Vector3i::Constant(-1));
    EXPECT_EQ(cut.max, Eigen::Vector3i::Constant(10));
}

}  // namespace
}  // namespace bonemill
