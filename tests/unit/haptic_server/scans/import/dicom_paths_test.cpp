// A path may name what leads to a series instead of its folder: a DICOMDIR, one slice.
#include <gtest/gtest.h>

#include <functional>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

constexpr double kStepMm = 0.75;

DicomImage picture(const std::string& uid, int k, int value) {
    DicomImage image;
    image.series_uid = uid;
    image.sop_uid = uid + "." + std::to_string(1000 * value + k);
    image.position = "10\\-20\\" + std::to_string(k * kStepMm);
    image.pixels.assign(20, int16_t(value + k));
    return image;
}

class DicomPaths : public testing::Test {
  protected:
    DicomPaths() {
        for (int k = 0; k < 9; ++k) writeDicomFile(folder_ / ("large" + std::to_string(k)), large(k));
        for (int k = 0; k < 5; ++k)
            writeDicomFile(folder_ / ("small" + std::to_string(k) + ".ima"), picture("1.2.2", k, 200));
    }
    static DicomImage large(int k) { return picture("1.2.1", k, 100); }
    static void expectSmall(const RawVolume& raw) {
        ASSERT_EQ(raw.geometry.dims, Eigen::Vector3i(5, 4, 5));
        EXPECT_NEAR(raw.geometry.spacing.z(), kStepMm * 1e-3, 0.05e-3);
        EXPECT_NEAR((raw.geometry.X_WV.position * 1e3 - Eigen::Vector3d(10, -20, 0)).norm(), 0, 0.05);
        for (size_t n = 0; n < raw.values.size(); ++n) EXPECT_EQ(raw.values[n], 200 + int(n / 20));
    }

    test::TemporaryFolder folder_;
};

TEST_F(DicomPaths, ASliceLeadsToItsSeries) {
    const RawVolume raw = importVolume(folder_ / "small3.ima");
    expectSmall(raw);
    EXPECT_NE(raw.description.find("small3.ima is a slice of this series: the folder " +
                                   folder_.path().string() + " was read"),
              std::string::npos)
        << raw.description;
    EXPECT_EQ(importVolume(folder_ / "large0").geometry.dims.z(), 9);
    EXPECT_EQ(importVolume(folder_ / "large0", {.series_uid = "1.2.2"}).geometry.dims.z(), 5);
}

TEST_F(DicomPaths, FoldersBesideASliceAreNotRead) {
    std::filesystem::create_directory(folder_ / "below");
    writeBytes(folder_ / "below/damaged", dicomBytes(large(3)).substr(0, 300));
    expectSmall(importVolume(folder_ / "small0.ima"));
    expectUserError([&] { importVolume(folder_.path()); }, {"damaged", "cut short"});
}

TEST_F(DicomPaths, ASliceLeadsToItsAcquisition) {
    for (int k = 0; k < 9; ++k)
        for (const int number : {1, 2}) {
            DicomImage image = picture("1.2.1", k, 100 * number);
            image.acquisition_number = std::to_string(number);
            writeDicomFile(folder_ / ((number == 1 ? "large" : "again") + std::to_string(k)), image);
        }
    EXPECT_EQ(importVolume(folder_ / "again4").values[0], 200);
    EXPECT_EQ(importVolume(folder_ / "large4").values[0], 100);
    EXPECT_EQ(importVolume(folder_ / "large4", {.acquisition = "2"}).values[0], 200);
}

TEST_F(DicomPaths, ADicomdirLeadsToItsFolder) {
    DicomImage directory = large(0);
    directory.has_pixels = false;
    writeDicomFile(folder_ / "dicomdir", directory);
    directory.sop_class = "1.2.840.10008.1.3.10";
    writeDicomFile(folder_ / "contents", directory);
    for (const char* name : {"dicomdir", "contents"}) {
        const RawVolume raw = importVolume(folder_ / name);
        EXPECT_EQ(raw.geometry.dims.z(), 9);
        EXPECT_NE(raw.description.find(std::string(name) + " only names files: the folder " +
                                       folder_.path().string() + " was read"),
                  std::string::npos)
            << raw.description;
        expectSmall(importVolume(folder_ / name, {.series_uid = "1.2.2"}));
    }
}

TEST_F(DicomPaths, AMultiFrameFileNeedsNoEnding) {
    DicomImage frames = picture("1.2.3", 0, 0);
    frames.pixels.clear();
    for (int k = 0; k < 3; ++k) {
        frames.frame_positions.push_back("0\\0\\" + std::to_string(k));
        frames.pixels.insert(frames.pixels.end(), 20, int16_t(k));
    }
    writeDicomFile(folder_ / "frames.IMA", frames);
    EXPECT_EQ(importVolume(folder_ / "frames.IMA").geometry.dims.z(), 3);
}

TEST_F(DicomPaths, OtherFilesAreStillOfNoKnownType) {
    writeBytes(folder_ / "notes.txt", std::string(1000, 'x'));
    expectUserError([&] { importVolume(folder_ / "notes.txt"); }, {"notes.txt", "no known type"});
    writeBytes(folder_ / "notes.dcm", std::string(1000, 'x'));
    expectUserError([&] { importVolume(folder_ / "notes.dcm"); }, {"notes.dcm", "not DICOM"});
}

}  // namespace
}  // namespace bonemill
