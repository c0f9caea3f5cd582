#include "haptic_server/surface/mesh/smooth_gradient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr size_t kStride[] = {1, 3, 9};
const IndexBox kReadable{Eigen::Vector3i::Constant(-1), Eigen::Vector3i::Constant(10)};

TEST(SmoothGradient, IsThatOfALinearField) {
    Density field[27];
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) field[i + 3 * j + 9 * k] = Density(1000 + 7 * i + 50 * j + 400 * k);
    const Eigen::Vector3f inverse_spacing(1000, 2000, 500);
    const Eigen::Vector3f g = smoothGradient({5, 5, 5}, kReadable, inverse_spacing, field + 13, kStride);
    EXPECT_FLOAT_EQ(g.x(), 7 * 1000);
    EXPECT_FLOAT_EQ(g.y(), 50 * 2000);
    EXPECT_FLOAT_EQ(g.z(), 400 * 500);
}

// Beyond the border there is nothing to be read.
TEST(SmoothGradient, AtTheBorderItIsOneSided) {
    Density field[27];
    std::fill(std::begin(field), std::end(field), kMaxDensity);
    field[13] = 0;
    field[14] = field[13 + 3] = field[13 + 9] = 500;
    field[14 + 3] = field[14 + 9] = field[13 + 12] = field[14 + 12] = 500;
    const Eigen::Vector3f g = smoothGradient({-1, -1, -1}, kReadable, {1, 1, 1}, field + 13, kStride);
    EXPECT_GT(g.x(), 0);
    EXPECT_LT(g.x(), 501);
    EXPECT_FLOAT_EQ(g.x(), g.y());
    EXPECT_FLOAT_EQ(g.x(), g.z());
}

// A scanned ball: its edge is 1.5 voxels wide.
TEST(SmoothGradient, TheNormalsOfAScannedBallLieWithinTwoDegreesOnAverage) {
    constexpr int kVoxels = 76;
    const Eigen::Vector3d middle(37.63, 37.37, 37.21);
    constexpr double kRadius = 34;
    VolumeGeometry geometry;
    geometry.dims.setConstant(kVoxels);
    geometry.spacing.setConstant(1e-3);
    VoxelVolume volume(geometry, 26000);
    test::forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        const double depth = kRadius - (Eigen::Vector3d(i, j, k) - middle).norm();
        volume.set(i, j, k, Density(std::lround(kMaxDensity * std::clamp(depth / 1.5 + 0.5, 0.0, 1.0))));
    });
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
    double sum = 0, largest = 0;
    size_t count = 0;
    LeafMesher mesher(volume, lattice);
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        const NodeMesh mesh = mesher.mesh(leaf).value();
        for (const PackedVertex& v : mesh.vertices) {
            const Eigen::Vector3d p =
                (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
            const Eigen::Vector3d n = decodeNormal(v.octahedral_u, v.octahedral_v).cast<double>();
            const double cosine = n.dot((p - 1e-3 * middle).normalized());
            const double degrees = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
            sum += degrees;
            largest = std::max(largest, degrees);
            ++count;
        }
    }
    ASSERT_GT(count, 1000u);
    EXPECT_LT(sum / double(count), 2);
    EXPECT_LT(largest, 6);
    RecordProperty("mean_degrees", std::to_string(sum / double(count)));
    RecordProperty("largest_degrees", std::to_string(largest));
}

}  // namespace
}  // namespace bonemill
