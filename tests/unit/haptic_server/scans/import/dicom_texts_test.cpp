// What the header's texts say is what is taken: a library's guess never stands for a number that is missing,
// unreadable or rounded.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

constexpr int kSlices = 4;

std::string placeText(double z_mm) {
    return "10\\-20\\" + std::to_string(z_mm);
}

DicomImage pictureAt(double z_mm) {
    DicomImage image;
    image.position = placeText(z_mm);
    image.sop_uid = "1.2.3.4." + std::to_string(int(100 * z_mm) + 1);
    for (int n = 0; n < image.rows * image.columns; ++n) image.pixels.push_back(int16_t(n + 100 * int(z_mm)));
    return image;
}

class DicomTexts : public ::testing::Test {
  protected:
    // Writes a stack of slices, each changed.
    template <class Change>
    void writeStack(Change change) {
        for (int k = 0; k < kSlices; ++k) {
            DicomImage image = pictureAt(k);
            change(image, k);
            writeDicomFile(folder_ / ("slice" + std::to_string(k)), image);
        }
    }
    void expectRefused(std::initializer_list<std::string> words) {
        expectUserError([&] { importVolume(folder_.path()); }, words);
    }
    RawVolume imported() { return importVolume(folder_.path()); }

    test::TemporaryFolder folder_;
};

TEST_F(DicomTexts, aPixelSpacingThatIsNoneIsRefused) {
    for (const char* spacing : {"", "0\\0", "0\\0.5", "-0.5\\0.5", "0,5\\0,5", "0.5", "0.5\\", "nan\\nan"}) {
        writeStack([&](DicomImage& image, int) { image.pixel_spacing = spacing; });
        SCOPED_TRACE(spacing);
        expectRefused({"slice0", "Pixel Spacing"});
    }
}

TEST_F(DicomTexts, aPositionThatIsNoneIsRefused) {
    for (const char* position : {"0\\0", "a\\b\\c", "0\\0\\1e999", "0\\0\\0\\0"}) {
        writeStack([&](DicomImage& image, int k) {
            if (k == 1) image.position = position;
        });
        SCOPED_TRACE(position);
        expectRefused({"slice1", "Image Position"});
    }
}

TEST_F(DicomTexts, anOrientationThatIsNoneIsRefused) {
    for (const char* orientation : {"0\\0\\0\\0\\0\\0", "1\\0\\0\\1\\0\\0", "1\\0\\0\\0.1\\1\\0", "1\\0\\0",
                                    "2\\0\\0\\0\\2\\0", "1\\0\\0\\0\\1\\x"}) {
        writeStack([&](DicomImage& image, int) { image.orientation = orientation; });
        SCOPED_TRACE(orientation);
        expectRefused({"slice0", "Image Orientation"});
    }
}

TEST_F(DicomTexts, anObliqueOrientationOfTwoDigitsIsReadAndSaid) {
    writeStack([](DicomImage& image, int) { image.orientation = "0.87\\0.50\\0\\-0.49\\0.87\\0"; });
    const RawVolume raw = imported();
    const Eigen::Matrix3d R = raw.geometry.X_WV.rotation.toRotationMatrix();
    EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)) * 180 / M_PI, 30, 0.5);
    EXPECT_NEAR(R.col(0).dot(R.col(1)), 0, 1e-12);
    EXPECT_NEAR(R(2, 2), 1, 1e-12);
    EXPECT_NE(raw.description.find("orientation is rounded"), std::string::npos) << raw.description;
}

TEST_F(DicomTexts, anExactOrientationIsNotSaidToBeRounded) {
    writeStack([](DicomImage& image, int) { image.orientation = "0.8\\0.6\\0\\-0.6\\0.8\\0"; });
    const RawVolume raw = imported();
    EXPECT_NEAR(raw.geometry.X_WV.rotation.toRotationMatrix()(1, 0), 0.6, 1e-12);
    EXPECT_EQ(raw.description.find("rounded"), std::string::npos) << raw.description;
}

TEST_F(DicomTexts, aTiltBeyondAnyGantryIsRefused) {
    writeStack([](DicomImage& image, int k) {
        image.position = "0\\" + std::to_string(1.2 * k) + "\\" + std::to_string(k);
    });
    expectRefused({"50.2 degrees", "gantry"});
}

TEST_F(DicomTexts, aSlopeThatIsNoneIsRefused) {
    writeStack([](DicomImage& image, int) { image.slope = 0; });
    expectRefused({"slice0", "Rescale Slope"});
}

// Magnetic resonance has such slopes in each of its slices, and GDCM leaves them out there.
TEST_F(DicomTexts, theSlopesOfOtherModalitiesAreHonoured) {
    writeStack([](DicomImage& image, int k) {
        image.modality = "MR";
        image.sop_class = "1.2.840.10008.5.1.4.1.1.4";
        image.slope = k + 1;
        image.intercept = -7;
    });
    const RawVolume raw = imported();
    for (int k = 0; k < kSlices; ++k)
        for (int n = 0; n < 20; ++n)
            EXPECT_EQ(raw.values[size_t(20 * k + n)], float((k + 1) * (n + 100 * k) - 7)) << k << " " << n;
}

// These are the stored values of frames that lie at z = 0, 1, 2.
DicomImage threeFrames(const std::vector<std::string>& rescales) {
    DicomImage image = pictureAt(0);
    image.pixels.clear();
    for (int k = 0; k < 3; ++k) {
        image.frame_positions.push_back(placeText(k));
        for (int n = 0; n < 20; ++n) image.pixels.push_back(int16_t(n + 100 * k));
    }
    image.frame_rescales = rescales;
    return image;
}

void expectFrames(const RawVolume& raw, const double (&slopes)[3], const double (&intercepts)[3]) {
    ASSERT_EQ(raw.values.size(), 60u);
    for (int k = 0; k < 3; ++k)
        for (int n = 0; n < 20; ++n)
            EXPECT_NEAR(raw.values[size_t(20 * k + n)], slopes[k] * (n + 100 * k) + intercepts[k], 1e-3)
                << "frame " << k << ", pixel " << n;
}

TEST_F(DicomTexts, eachFrameIsScaledAsItSays) {
    writeDicomFile(folder_ / "a.dcm", threeFrames({"1|-1024", "1|0", "1|-1024"}));
    expectFrames(imported(), {1, 1, 1}, {-1024, 0, -1024});
    writeDicomFile(folder_ / "a.dcm", threeFrames({"1|0", "2.5|-1000", "0.5|-1024.5"}));
    expectFrames(imported(), {1, 2.5, 0.5}, {0, -1000, -1024.5});
    writeDicomFile(folder_ / "a.dcm", threeFrames({"0.75|-1000", "1|0", "2|-1024"}));
    expectFrames(imported(), {0.75, 1, 2}, {-1000, 0, -1024});
}

TEST_F(DicomTexts, theScaleOfAllFramesIsHonoured) {
    DicomImage image = threeFrames({});
    image.shared_rescale = "2|-1024";
    writeDicomFile(folder_ / "a.dcm", image);
    expectFrames(imported(), {2, 2, 2}, {-1024, -1024, -1024});
}

TEST_F(DicomTexts, framesOfWhichOneDoesNotSayItsScaleAreRefused) {
    writeDicomFile(folder_ / "a.dcm", threeFrames({"1|-1024", "", "1|-1024"}));
    expectRefused({"a.dcm frame 2", "Rescale"});
    writeDicomFile(folder_ / "a.dcm", threeFrames({"1|-1024", "0|0", "1|-1024"}));
    expectRefused({"a.dcm frame 2", "Rescale Slope"});
}

TEST_F(DicomTexts, framesAreHeldToTheirTextsToo) {
    const auto expectFrameRefused = [&](auto change, const char* what) {
        DicomImage image = threeFrames({});
        change(image);
        writeDicomFile(folder_ / "a.dcm", image);
        expectRefused({"a.dcm frame", what});
    };
    expectFrameRefused([](DicomImage& image) { image.orientation = "1.002\\0\\0\\0\\1\\0"; },
                       "Image Orientation");
    expectFrameRefused([](DicomImage& image) { image.orientation = "1\\0\\0\\0\\0\\0"; },
                       "Image Orientation");
    expectFrameRefused([](DicomImage& image) { image.pixel_spacing = "0\\0.5"; }, "Pixel Spacing");
    expectFrameRefused([](DicomImage& image) { image.pixel_spacing = "x\\0.5"; }, "Pixel Spacing");
    expectFrameRefused([](DicomImage& image) { image.frame_positions[1] = "0\\y\\1"; }, "Image Position");
}

TEST_F(DicomTexts, frameOrientationsAreMadeUnitVectors) {
    DicomImage image = threeFrames({});
    image.orientation = "0.866\\0.5\\0\\-0.5\\0.866\\0";
    writeDicomFile(folder_ / "a.dcm", image);
    const Eigen::Matrix3d R = imported().geometry.X_WV.rotation.toRotationMatrix();
    EXPECT_NEAR(R.col(0).norm(), 1, 1e-12);
    EXPECT_NEAR(R(0, 0), std::sqrt(0.75), 1e-4);
}

TEST_F(DicomTexts, linksThatLeadNowhereDoNotStopTheFolder) {
    writeStack([](DicomImage&, int) {});
    std::filesystem::create_symlink("loop", folder_ / "loop");
    std::filesystem::create_symlink("nothing", folder_ / "gone");
    const RawVolume raw = imported();
    EXPECT_EQ(raw.geometry.dims.z(), kSlices);
    EXPECT_NE(raw.description.find("2 links"), std::string::npos) << raw.description;
}

}  // namespace
}  // namespace bonemill
