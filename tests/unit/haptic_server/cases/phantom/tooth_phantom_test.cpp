#include "haptic_server/cases/phantom/tooth_phantom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "haptic_server/cases/phantom_dicom/dicom_series_writer.h"
#include "haptic_server/scans/find_bone/propose_iso.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

ToothTissue at(double x_mm, double y_mm, double z_mm) {
    return toothTissue(Eigen::Vector3d(x_mm, y_mm, z_mm) / 1000);
}

struct Extent {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = Eigen::Vector3d::Constant(-1e9);
};

Extent extentOfTooth() {
    Extent extent;
    for (double z = 0; z <= 20; z += 0.1)
        for (double y = -8; y <= 8; y += 0.1)
            for (double x = -8; x <= 8; x += 0.1)
                if (at(x, y, z) != ToothTissue::kAir) {
                    extent.low = extent.low.cwiseMin(Eigen::Vector3d(x, y, z));
                    extent.high = extent.high.cwiseMax(Eigen::Vector3d(x, y, z));
                }
    return extent;
}

TEST(ToothPhantom, hasTheSizeOfAMolar) {
    const Extent extent = extentOfTooth();
    const Eigen::Vector3d size = extent.high - extent.low;
    EXPECT_NEAR(size.x(), 11, 0.3);
    EXPECT_NEAR(size.y(), 10.5, 0.3);
    EXPECT_GT(size.z(), 18.3);
    EXPECT_GE(extent.low.z(), 0.3);
    EXPECT_LE(extent.high.z(), 19.8);
    EXPECT_NEAR(extent.low.x() + extent.high.x(), 0, 0.3);
    EXPECT_NEAR(extent.low.y() + extent.high.y(), 0, 0.3);
}

TEST(ToothPhantom, hasItsParts) {
    EXPECT_EQ(at(0, 0, 11.6), ToothTissue::kPulp);
    EXPECT_EQ(at(0.9, 0.1, 15.5), ToothTissue::kCaries);
    EXPECT_EQ(at(3.5, 0, 10), ToothTissue::kDentine);
    EXPECT_EQ(at(5.2, 0, 14.6), ToothTissue::kEnamel);
    EXPECT_EQ(at(0, 0, 5), ToothTissue::kAir);         // between the roots
    EXPECT_EQ(at(-2.6, 0, 6), ToothTissue::kDentine);  // mesial root, between its two canals
    EXPECT_LT(int(at(0.9, 0.1, 17.2)), int(ToothTissue::kDentine))
        << "the caries must be open to the fissure";
}

// A vertical corridor down the tooth axis meets hard tissue, then the pulp.
TEST(ToothPhantom, corridorFromTheCrownMeetsItsTissuesInOrder) {
    std::vector<ToothTissue> met;
    for (double z = 20; z > 10.5; z -= 0.01)
        if (met.empty() || met.back() != at(-0.8, 0.6, z)) met.push_back(at(-0.8, 0.6, z));
    const std::vector<ToothTissue> expected = {ToothTissue::kAir, ToothTissue::kEnamel, ToothTissue::kDentine,
                                               ToothTissue::kPulp};
    std::vector<ToothTissue> without_caries;
    for (const ToothTissue t : met)
        if (t != ToothTissue::kCaries && (without_caries.empty() || without_caries.back() != t))
            without_caries.push_back(t);
    EXPECT_EQ(without_caries, expected);
}

VolumeGeometry coarseGrid() {
    VolumeGeometry geometry = toothGrid();
    geometry.dims = {33, 32, 21};
    geometry.spacing.setConstant(1e-3);
    geometry.X_WV.position = {-16e-3, -15.5e-3, 0};
    return geometry;
}

TEST(ToothPhantom, comesBackFromItsDicomSeriesUnchanged) {
    const test::TemporaryFolder folder;
    const RawVolume tooth = scanTooth(coarseGrid(), {.noise_hu = 20, .seed = 4});
    writeCtSeries(folder.path(), tooth, {"PHANTOM^TOOTH", "test", "seed"});
    const RawVolume raw = importVolume(folder.path());
    EXPECT_EQ(raw.values, tooth.values);
    EXPECT_EQ(raw.geometry.dims, tooth.geometry.dims);
    EXPECT_EQ(raw.geometry.spacing, tooth.geometry.spacing);
    EXPECT_LT((raw.geometry.X_WV.position - tooth.geometry.X_WV.position).norm(), 1e-12);
    EXPECT_EQ(raw.geometry.X_WV.rotation.coeffs(), tooth.geometry.X_WV.rotation.coeffs());
    EXPECT_TRUE(raw.is_hounsfield);
}

TEST(ToothPhantom, turnedSeriesComesBackTurned) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry = coarseGrid();
    geometry.X_WV.rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 1, 0).normalized()));
    RawVolume tooth = scanTooth(coarseGrid(), {});
    tooth.geometry = geometry;
    writeCtSeries(folder.path(), tooth, {"PHANTOM^TOOTH", "test", "seed"});
    const RawVolume raw = importVolume(folder.path());
    EXPECT_EQ(raw.values, tooth.values);
    EXPECT_LT(raw.geometry.X_WV.rotation.angularDistance(geometry.X_WV.rotation), 1e-6);
    EXPECT_LT((raw.geometry.X_WV.position - geometry.X_WV.position).norm(), 1e-9);
}

TEST(ToothPhantom, edgesAreSoftAndTissuesPure) {
    VolumeGeometry geometry = toothGrid();
    geometry.dims = {256, 1, 2};  // one line through the crown
    geometry.X_WV.position += Eigen::Vector3d(0, 127.5 * 0.125e-3, 14e-3);
    const RawVolume line = scanTooth(geometry, {});
    std::set<float> between;
    for (size_t n = 0; n < line.values.size(); ++n) {
        const float v = line.values[n];
        if (v > -1000 && v < 2900 && v != 1600 && v != 700 && v != 40) between.insert(v);
    }
    EXPECT_GE(between.size(), 4u) << "partial volume";
    EXPECT_EQ(line.values.range().high, 2900);
    EXPECT_EQ(line.values.range().low, -1000);
}

TEST(ToothPhantom, noiseHasTheStatedSizeAndIsRepeatable) {
    VolumeGeometry air = coarseGrid();
    air.X_WV.position.z() = 30e-3;
    const RawVolume a = scanTooth(air, {.noise_hu = 50, .seed = 1}),
                    b = scanTooth(air, {.noise_hu = 50, .seed = 1});
    EXPECT_EQ(a.values, b.values);
    EXPECT_NE(a.values, scanTooth(air, {.noise_hu = 50, .seed = 2}).values);
    double sum = 0, squares = 0;
    const double n = double(a.values.size());
    for (size_t i = 0; i < a.values.size(); ++i) {
        const double v = a.values[i] + 1000;
        sum += v;
        squares += v * v;
    }
    EXPECT_NEAR(sum / n, 0, 2);
    EXPECT_NEAR(std::sqrt(squares / n), 50, 2);
}

TEST(ToothPhantom, uidsAreValid) {
    for (const char* text : {"", "a", "series 1", "series 2"}) {
        const std::string uid = uidFromText(text);
        EXPECT_LE(uid.size(), 64u);
        EXPECT_EQ(uid.rfind("2.25.", 0), 0u);
        EXPECT_NE(uid[5], '0');
        EXPECT_EQ(uid.find_first_not_of("0123456789."), std::string::npos);
    }
    EXPECT_NE(uidFromText("series 1"), uidFromText("series 2"));
}

}  // namespace
}  // namespace bonemill
