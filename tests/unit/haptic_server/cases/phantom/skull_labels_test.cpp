#include "haptic_server/cases/phantom/skull_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "haptic_server/scans/import/import_volume.h"

namespace bonemill {
namespace {

const char* const kCranium = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";

// The grid is finer than the scan, around the left mastoid.
VolumeGeometry mastoidGrid() {
    VolumeGeometry geometry;
    geometry.dims = {60, 100, 64};
    geometry.spacing.setConstant(0.6e-3);
    geometry.X_WV.position = {0.150, 0.122, 0.015};
    return geometry;
}

TEST(SkullLabels, HoldSinusNerveAndDuraOfTheirSizes) {
    const VolumeGeometry grid = mastoidGrid();
    const std::vector<uint8_t> labels = skullLabels(grid);
    ASSERT_EQ(labels.size(), grid.voxelCount());
    std::map<SkullLabel, double> volume_mm3;
    double nerve_section_mm2 = 0;  // level, mean of z = 24 .. 28.8 mm, where the nerve is upright
    for (size_t n = 0; n < labels.size(); ++n) {
        volume_mm3[SkullLabel(labels[n])] += std::pow(0.6, 3);
        const size_t slice = n / size_t(grid.dims.x() * grid.dims.y());
        const bool is_there = slice >= 15 && slice <= 23;
        if (is_there && labels[n] == uint8_t(SkullLabel::kFacialNerve)) nerve_section_mm2 += 0.36 / 9;
    }
    EXPECT_NEAR(nerve_section_mm2, M_PI, 0.5);
    EXPECT_GT(volume_mm3[SkullLabel::kSigmoidSinus], M_PI * 4.5 * 4.5 * 40);
    EXPECT_NEAR(volume_mm3[SkullLabel::kDura], 24 * 24 * 2, 250);
}

// Soft structures lie in soft places, the nerve in the bone between mastoid cells and jugular bulb.
TEST(SkullLabels, FitTheScanTheyAreMadeFor) {
    if (!std::filesystem::exists(kCranium)) GTEST_SKIP() << kCranium << " is not installed";
    const RawVolume scan = importVolume(kCranium);
    ASSERT_EQ(scan.geometry.dims, kCraniumDims);
    const std::vector<uint8_t> labels = skullLabels(scan.geometry);
    constexpr double kIsBone = 300, kIsAir = -400;
    std::map<SkullLabel, int> all, in_bone, in_air;
    for (size_t n = 0; n < labels.size(); ++n) {
        const SkullLabel label{labels[n]};
        ++all[label];
        in_bone[label] += scan.values[n] >= kIsBone;
        in_air[label] += scan.values[n] < kIsAir;
    }
    EXPECT_LT(in_bone[SkullLabel::kSigmoidSinus], all[SkullLabel::kSigmoidSinus] / 10);
    EXPECT_EQ(in_air[SkullLabel::kSigmoidSinus], 0);
    EXPECT_LT(in_bone[SkullLabel::kDura], all[SkullLabel::kDura] / 3);
    EXPECT_LT(in_air[SkullLabel::kDura], all[SkullLabel::kDura] / 20);
    EXPECT_GT(in_bone[SkullLabel::kFacialNerve], all[SkullLabel::kFacialNerve] / 2);
}

}  // namespace
}  // namespace bonemill
