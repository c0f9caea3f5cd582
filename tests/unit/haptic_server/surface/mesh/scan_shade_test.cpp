#include "haptic_server/surface/mesh/scan_shade.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kScanVoxel = 1e-3;
constexpr Density kShadeIso = 20000;
constexpr int kScanSize = 40;

ShadeScale scaleOfShades() {
    ShadeScale scale{10, 32, 20000, 60000, {}};
    scale.stands_for[1] = true;
    return scale;
}

// As a scanner sees it: bone of this density in voxels and, beside air, a mixture.
VoxelVolume scanned(const std::function<double(const Vector3d&)>& depth,
                    const std::function<double(const Vector3d&)>& density) {
    VoxelVolume volume(
        test::boxGeometry(Eigen::Vector3i::Constant(kScanSize), Vector3d::Constant(kScanVoxel)), kShadeIso);
    test::forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        const Vector3d p = kScanVoxel * Vector3d(i, j, k);
        const double share = std::clamp(0.5 + depth(p) / (2 * kScanVoxel), 0.0, 1.0);
        volume.set(i, j, k, Density(share * density(p)));
    });
    return volume;
}

ScanShade shadeOf(const VoxelVolume& scan) {
    return {scaleOfShades(), scan.geometry(), Pose{}, scan.iso(), densitiesOf(scan)};
}

const Vector3d kShadedBallAt = Vector3d::Constant(kScanVoxel * (kScanSize - 1) / 2.0);
double depthInBall(const Vector3d& p) {
    return 15e-3 - (p - kShadedBallAt).norm();
}
double depthInCylinder(const Vector3d& p) {
    return 12e-3 - (p - kShadedBallAt).head<2>().norm();
}

// Shades of places all over the surface.
std::vector<int> shadesOn(const VoxelVolume& scan, bool is_ball) {
    ScanShade shade = shadeOf(scan);
    std::vector<int> shades;
    for (int n = 0; n < 4000; ++n) {
        const double turn = 2.399963 * n,
                     height = is_ball ? 1 - 2 * (n + 0.5) / 4000 : (n % 100) / 100.0 - 0.5;
        const double radius = is_ball ? std::sqrt(1 - height * height) : 1;
        const Vector3d out(radius * std::cos(turn), radius * std::sin(turn), is_ball ? height : 0);
        const Vector3d place = is_ball
                                   ? Vector3d(kShadedBallAt + 15e-3 * out)
                                   : Vector3d(kShadedBallAt + 12e-3 * out + Vector3d(0, 0, 20e-3 * height));
        shades.push_back(shade.under(place.cast<float>(), out.cast<float>()));
    }
    return shades;
}

TEST(ScanShade, OneBoneHasOneShadeWhateverItsShape) {
    const auto same = [](const Vector3d&) { return 45000.0; };
    for (const bool is_ball : {true, false}) {
        const auto shades = shadesOn(scanned(is_ball ? depthInBall : depthInCylinder, same), is_ball);
        const auto [least, most] = std::ranges::minmax(shades);
        EXPECT_LE(most - least, 1) << is_ball;
        // The mixture beside air draws it down, by a ninth of the scale.
        EXPECT_NEAR(least, 10 + 31 * (45000 - 20000) / 40000.0, 3.5) << is_ball;
    }
}

TEST(ScanShade, FollowsTheValueWithoutSteps) {
    const auto rising = [](const Vector3d& p) { return 25000 + 30000 * p.x() / (kScanSize * kScanVoxel); };
    const VoxelVolume scan = scanned([](const Vector3d& p) { return 20e-3 - p.z(); }, rising);
    ScanShade shade = shadeOf(scan);
    int before = 0;
    for (double x = 5e-3; x < 35e-3; x += 0.1e-3) {
        const int now = shade.under(Vector3d(x, 20e-3, 20e-3).cast<float>(), Vector3f::UnitZ());
        EXPECT_TRUE(before == 0 || now == before || now == before + 1) << x;
        before = now;
    }
    EXPECT_GT(before, 10 + 20);
}

// A sheet of air cells a voxel apart is noise to the eye: its shade does not change from voxel to voxel.
TEST(ScanShade, SmoothsWhatIsFinerThanTheScan) {
    const auto noisy = [](const Vector3d& p) {
        const Eigen::Vector3i v = (p / kScanVoxel).array().round().cast<int>();
        return (v.sum() & 1) != 0 ? 30000.0 : 50000.0;
    };
    const auto shades = shadesOn(scanned(depthInBall, noisy), true);
    const auto [least, most] = std::ranges::minmax(shades);
    EXPECT_LE(most - least, 4);
}

TEST(ScanShade, IsTheSameInAnyFrame) {
    const auto rising = [](const Vector3d& p) { return 25000 + 0.7e6 * (p.x() + p.y()); };
    const VoxelVolume scan = scanned(depthInBall, rising);
    const Pose X_SV{Vector3d(3e-3, -2e-3, 8e-3),
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()))};
    ScanShade here = shadeOf(scan),
              there(scaleOfShades(), scan.geometry(), X_SV, scan.iso(), densitiesOf(scan));
    for (int n = 0; n < 200; ++n) {
        const Vector3d out = Vector3d(std::cos(n), std::sin(n), std::sin(2.0 * n)).normalized();
        const Vector3d p_S = kShadedBallAt + 15e-3 * out;
        const int other = there.under((X_SV.inverse() * p_S).cast<float>(),
                                      (X_SV.rotation.conjugate() * out).cast<float>());
        EXPECT_NEAR(here.under(p_S.cast<float>(), out.cast<float>()), other, 1);
    }
}

TEST(ScanShade, OutsideTheScanIsTheLowest) {
    const VoxelVolume scan = scanned(depthInBall, [](const Vector3d&) { return 45000.0; });
    EXPECT_EQ(shadeOf(scan).under(Vector3f(1, 1, 1), Vector3f::UnitX()), 10);
}

}  // namespace
}  // namespace bonemill
