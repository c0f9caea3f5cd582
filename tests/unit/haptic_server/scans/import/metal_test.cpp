// Phantoms whose metal is known: a ball of it in a ball of soft tissue, with streaks as bands from its
// middle.
#include "haptic_server/scans/find_bone/metal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

constexpr double kMetalMm = 1e-3;

VolumeGeometry gridOf(const Eigen::Vector3i& dims = {112, 104, 40}) {
    VolumeGeometry grid;
    grid.dims = dims;
    grid.spacing = Eigen::Vector3d(0.8, 0.8, 1) * kMetalMm;
    return grid;
}

// What share of a voxel lies within a surface at this distance.
double shareIn(double distance) {
    return std::clamp(0.5 - distance / (0.8 * kMetalMm), 0.0, 1.0);
}

struct Phantom {
    double radius = 5 * kMetalMm;  // of the metal; 0: there is none
    double metal_hu = 9000, bone_hu = 1500;
    double streaks_hu = 0;  // 10 mm from the middle; they fade as 1 / r
    double noise_hu = 10;
    double highest_hu = 3071;
    double shift = 0;
    Eigen::Vector3d middle = Eigen::Vector3d(40, 42, 20) * kMetalMm;

    // Tissue of 40 HU in air, with a rod of bone along z, and metal.
    RawVolume scan(const VolumeGeometry& grid = gridOf()) const {
        std::mt19937 random(5);
        std::normal_distribution<double> grain(0, std::max(noise_hu, 1e-9));
        RawVolume scan = scanOf(grid, [&](const Eigen::Vector3d& p) {
            const double in_metal = radius > 0 ? shareIn((p - middle).norm() - radius) : 0;
            const double in_bone =
                shareIn(std::hypot(p.x() - 60 * kMetalMm, p.y() - 55 * kMetalMm) - 6 * kMetalMm);
            const double in_tissue =
                shareIn(std::hypot(p.x() - 45 * kMetalMm, p.y() - 42 * kMetalMm) - 38 * kMetalMm);
            double hu = -1000 + in_tissue * (1040 + streaksAt(p)) + in_bone * (bone_hu - 40);
            hu += grain(random);
            hu += in_metal * (metal_hu - hu);
            return std::round(std::clamp(hu, -1024.0, highest_hu) + shift);
        });
        scan.is_hounsfield = shift == 0;
        return scan;
    }

  private:
    double streaksAt(const Eigen::Vector3d& p) const {
        const Eigen::Vector3d from = p - middle;
        if (std::abs(from.z()) > radius) return 0;
        const double r = std::max(std::hypot(from.x(), from.y()), 4 * kMetalMm);
        return streaks_hu * 10 * kMetalMm / r * std::sin(18 * std::atan2(from.y(), from.x()));
    }
};

double volumeOf(const Metal& metal, const VolumeGeometry& grid) {
    double voxels = 0;
    for (const MetalPiece& piece : metal.pieces) voxels += double(piece.voxels);
    return voxels * grid.spacing.prod();
}

double ball(double radius) {
    return 4 * std::numbers::pi / 3 * radius * radius * radius;
}

TEST(Metal, BoneHasNone) {
    const RawVolume scan = Phantom{.radius = 0, .noise_hu = 40}.scan();
    EXPECT_TRUE(findMetal(scan).pieces.empty());
    EXPECT_EQ(textOf(findMetal(scan), scan.geometry), "");
}

TEST(Metal, ABallOfItIsFoundWithItsVolumeItsPlaceAndTheScannersEnd) {
    const Phantom phantom{.streaks_hu = 200};
    const RawVolume scan = phantom.scan();
    const Metal metal = findMetal(scan);
    ASSERT_EQ(metal.pieces.size(), 1u);
    EXPECT_NEAR(volumeOf(metal, scan.geometry), ball(phantom.radius), 0.1 * ball(phantom.radius));
    EXPECT_LT((metal.pieces[0].middle.cwiseProduct(scan.geometry.spacing) - phantom.middle).norm(),
              0.2 * kMetalMm);
    EXPECT_TRUE(metal.is_clipped);
    EXPECT_EQ(metal.highest, 3071);
    EXPECT_GE(scan.values[indexOf(scan.geometry, metal.pieces[0].first)], 3050);
    const std::string text = textOf(metal, scan.geometry);
    for (const char* const part :
         {"in one piece around (40.", "values end at 3071 HU", "streaks spoil", "z = 15"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
}

// At r the bands have an amplitude of 2000 HU mm / r; the tissue ends 38 mm from its middle.
TEST(Metal, ItsStreaksAreMeasuredAgainstSlicesWithout) {
    const Metal strong = findMetal(Phantom{.streaks_hu = 200}.scan());
    ASSERT_TRUE(strong.streaks);
    EXPECT_EQ(strong.streaks->last_slice - strong.streaks->first_slice + 1, 11);
    EXPECT_GT(strong.streaks->spread, 70);
    EXPECT_NEAR(strong.streaks->usual_spread, 10, 3);
    EXPECT_GE(strong.streaks->reach, 20 * kMetalMm);
    const Metal weak = findMetal(Phantom{.streaks_hu = 100}.scan());
    ASSERT_TRUE(weak.streaks);
    EXPECT_GT(weak.streaks->reach, 0);
    EXPECT_LT(weak.streaks->reach, strong.streaks->reach);
}

TEST(Metal, MayHaveNoStreaks) {
    const RawVolume scan = Phantom{}.scan();
    const Metal metal = findMetal(scan);
    ASSERT_TRUE(metal.streaks);
    EXPECT_EQ(metal.streaks->reach, 0);
    EXPECT_NEAR(metal.streaks->spread, metal.streaks->usual_spread, 3);
    EXPECT_NE(textOf(metal, scan.geometry).find("too faint"), std::string::npos);
}

// Tissue that is as uneven everywhere is not the metal's doing.
TEST(Metal, IsNotBlamedForUnevenTissue) {
    const Metal metal = findMetal(Phantom{.noise_hu = 80}.scan());
    ASSERT_TRUE(metal.streaks);
    EXPECT_EQ(metal.streaks->reach, 0);
    EXPECT_GT(metal.streaks->spread, 70);
}

TEST(Metal, InAirShowsNoStreaks) {
    const RawVolume scan = scanOf(gridOf(), [](const Eigen::Vector3d& p) {
        return (p - Eigen::Vector3d(40, 42, 20) * kMetalMm).norm() < 4 * kMetalMm ? 3071.0 : -1000.0;
    });
    const Metal metal = findMetal(scan);
    ASSERT_EQ(metal.pieces.size(), 1u);
    EXPECT_FALSE(metal.streaks);
    EXPECT_NE(textOf(metal, scan.geometry).find("no soft tissue around it"), std::string::npos);
}

TEST(Metal, DenseEnamelIsNone) {
    for (const double enamel : {2500.0, 2900.0, 3000.0})
        for (const double noise : {0.0, 40.0, 100.0}) {
            const Phantom tooth{.radius = 0, .bone_hu = enamel, .noise_hu = noise};
            const Metal metal = findMetal(tooth.scan());
            EXPECT_TRUE(metal.pieces.empty())
                << enamel << " HU with noise of " << noise << ": " << metal.pieces.size()
                << " pieces, the largest of " << metal.pieces[0].voxels << " voxels";
        }
}

TEST(Metal, ThinEnamelIsNone) {
    std::mt19937 random(7);
    std::normal_distribution<double> grain(0, 60);
    const RawVolume scan = scanOf(gridOf(), [&](const Eigen::Vector3d& p) {
        const double d = std::abs((p - Eigen::Vector3d(40, 42, 20) * kMetalMm).norm() - 14 * kMetalMm);
        return std::min(3071.0, std::round((d < 0.8 * kMetalMm ? 2950 : -1000) + grain(random)));
    });
    EXPECT_TRUE(findMetal(scan).pieces.empty());
}

TEST(Metal, NoiseIsNone) {
    const RawVolume scan = Phantom{.radius = 0, .noise_hu = 700}.scan();
    ASSERT_EQ(scan.values.range().high, 3071) << "or the test says nothing";
    EXPECT_TRUE(findMetal(scan).pieces.empty());
}

// Two voxels are as much as a scan shows of a clip; one is a fault of the scan's.
TEST(Metal, MayBeAsSmallAsAClip) {
    const auto clipOf = [](double length) {
        return scanOf(gridOf(), [=](const Eigen::Vector3d& p) {
            const Eigen::Vector3d from = p - Eigen::Vector3d(8, 8, 7.4) * kMetalMm;
            const bool is_clip = std::max(std::abs(from.x()), std::abs(from.y())) < 0.1 * kMetalMm;
            return is_clip && std::abs(from.z()) < length ? 3071.0 : -800.0;
        });
    };
    const Metal metal = findMetal(clipOf(1 * kMetalMm));
    ASSERT_EQ(metal.pieces.size(), 1u);
    EXPECT_EQ(metal.pieces[0].voxels, 2u);
    EXPECT_TRUE(findMetal(clipOf(0.5 * kMetalMm)).pieces.empty()) << "one voxel";
}

TEST(Metal, IsFoundOnAShiftedScaleToo) {
    const Phantom phantom{.shift = 1024};
    const RawVolume scan = phantom.scan();
    const Metal metal = findMetal(scan);
    ASSERT_EQ(metal.pieces.size(), 1u);
    EXPECT_NEAR(volumeOf(metal, scan.geometry), ball(phantom.radius), 0.1 * ball(phantom.radius));
    EXPECT_EQ(metal.water, 1024);
    EXPECT_EQ(metal.highest, 3071);
    EXPECT_NE(textOf(metal, scan.geometry).find("if the values are Hounsfield units"), std::string::npos);
}

TEST(Metal, OfALongScaleIsNotClipped) {
    const Metal metal = findMetal(Phantom{.noise_hu = 30, .highest_hu = 32767}.scan());
    ASSERT_EQ(metal.pieces.size(), 1u);
    EXPECT_NEAR(metal.highest, 9000, 1);
    EXPECT_EQ(findMetal(Phantom{.highest_hu = 8191}.scan()).is_clipped, true);
}

TEST(Metal, IsNotLookedForOnUnknownScales) {
    const RawVolume scan = Phantom{.streaks_hu = 200}.scan();
    const auto scaled = [&](double factor) {
        size_t n = 0;
        return scanOf(scan.geometry, [&](const Eigen::Vector3d&) {
            return std::round((double(scan.values[n++]) + 1024) * factor);
        });
    };
    EXPECT_TRUE(findMetal(scaled(255.0 / 4095)).pieces.empty()) << "8 bit";
    EXPECT_TRUE(findMetal(scaled(65535.0 / 4095)).pieces.empty()) << "16 bit";
    EXPECT_TRUE(
        findMetal(scanOf(gridOf(),
                         [](const Eigen::Vector3d& p) { return p.x() < 20 * kMetalMm ? -20000.0 : 20000.0; }))
            .pieces.empty())
        << "half of it";
}

// Shot, or a fault of the scan's: it is looked at as far as the largest pieces go.
TEST(Metal, MayBeInVeryManyPieces) {
    const VolumeGeometry grid = gridOf({240, 240, 20});
    std::vector<float> values(grid.voxelCount(), 40);
    size_t count = 0;
    for (int k = 4; k < 16; k += 3)
        for (int j = 1; j < 239; j += 3)
            for (int i = 1; i < 239; i += 3, ++count)
                for (const int z : {k, k + 1}) values[indexOf(grid, {i, j, z})] = 3071;
    values[0] = -1000;
    RawVolume scan;
    scan.geometry = grid;
    scan.values.append(std::span<const float>(values));
    const Metal metal = findMetal(scan);
    EXPECT_EQ(metal.pieces.size(), count);
    EXPECT_TRUE(metal.streaks);
}

// Fillings on both sides: told apart, the larger one first, with the slices of that one.
TEST(Metal, MayBeInPieces) {
    const auto in = [](const Eigen::Vector3d& p, double x, double z, double r) {
        return (p - Eigen::Vector3d(x, 42, z) * kMetalMm).norm() < r * kMetalMm;
    };
    const RawVolume scan = scanOf(gridOf(), [&](const Eigen::Vector3d& p) {
        return in(p, 20, 10, 3) || in(p, 60, 28, 4) ? 3071.0 : p.x() < 2 * kMetalMm ? -1000.0 : 40.0;
    });
    const Metal metal = findMetal(scan);
    ASSERT_EQ(metal.pieces.size(), 2u);
    EXPECT_GT(metal.pieces[0].voxels, metal.pieces[1].voxels);
    EXPECT_NEAR(metal.pieces[0].middle.z(), 28, 0.1);
    ASSERT_TRUE(metal.streaks);
    EXPECT_EQ(metal.streaks->first_slice, 25);
    EXPECT_EQ(metal.streaks->last_slice, 31);
    EXPECT_NE(textOf(metal, scan.geometry).find("in 2 pieces: "), std::string::npos);
}

}  // namespace
}  // namespace bonemill
