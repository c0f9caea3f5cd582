// Reads real scans where BONEMILL_CT_DATA names a folder that holds them (docs/reference/volumes.md), and is
// skipped elsewhere. The other files prove the same behaviour with made data.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ostream>

#include "haptic_server/scans/find_bone/propose_iso.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/whole_densities.h"

namespace bonemill {
namespace {

struct RealScan {
    const char* path;
    Eigen::Vector3i dims;
    double iso_low, iso_high;
};

void PrintTo(const RealScan& scan, std::ostream* out) {
    *out << scan.path;
}

const RealScan kScans[] = {
    {"tooth16_seg3d/tooth.nhdr", {103, 94, 161}, 560, 660},
    {"tooth8_vtkjs/tooth.nrrd", {103, 94, 161}, 110, 128},
    {"spine_lidc/spine_256x151x197.nrrd", {256, 151, 197}, 200, 400},
    {"vertebra_labels_tptbox/sub-ct_label-22_ct.nii.gz", {73, 47, 73}, 180, 300},
    {"head_phantom_ct_dicom/head_phantom_bone_512x512x140", {512, 512, 140}, 300, 450},
    {"head_tiny_dicom/head_tiny_64x64x93", {64, 64, 93}, 1220, 1330},
};

class RealData : public ::testing::TestWithParam<RealScan> {};

TEST_P(RealData, isImportedWithASensibleIsoValue) {
    const char* folder = std::getenv("BONEMILL_CT_DATA");
    if (!folder) GTEST_SKIP() << "BONEMILL_CT_DATA is not set";
    const auto path = std::filesystem::path(folder) / GetParam().path;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there (unpacked?)";
    const RawVolume raw = importVolume(path);
    EXPECT_EQ(raw.geometry.dims, GetParam().dims);
    const double iso = proposeIso(raw).value;
    EXPECT_GE(iso, GetParam().iso_low);
    EXPECT_LE(iso, GetParam().iso_high);
    EXPECT_NO_THROW(densify(raw, DensityWindow{}));
}

INSTANTIATE_TEST_SUITE_P(Scans, RealData, ::testing::ValuesIn(kScans));

}  // namespace
}  // namespace bonemill
