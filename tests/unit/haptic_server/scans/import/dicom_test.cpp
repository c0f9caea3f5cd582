#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "haptic_server/scans/dicom/dicom_scan.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

std::string triple(const Eigen::Vector3d& v) {
    char text[64];
    std::snprintf(text, sizeof text, "%.8f\\%.8f\\%.8f", v.x(), v.y(), v.z());
    return text;
}

DicomImage sliceOf(const SampleVolume& sample, int k) {
    DicomImage image;
    image.rows = sample.dims.y();
    image.columns = sample.dims.x();
    char spacing[48];
    std::snprintf(spacing, sizeof spacing, "%g\\%g", sample.spacing_mm.y(), sample.spacing_mm.x());
    image.pixel_spacing = spacing;
    image.orientation = triple(sample.directions.col(0)) + "\\" + triple(sample.directions.col(1));
    image.position = triple(sample.origin_mm + sample.directions.col(2) * sample.spacing_mm.z() * k);
    image.sop_uid = "1.2.3.4." + std::to_string(k + 1);
    const auto all = sample.values();
    const auto size = sample.dims.x() * sample.dims.y();
    image.pixels.assign(all.begin() + size * k, all.begin() + size * (k + 1));
    return image;
}

// The file names are in no order that means anything.
void writeSeries(const std::filesystem::path& folder, const SampleVolume& sample) {
    std::vector<int> names(size_t(sample.dims.z()));
    for (size_t n = 0; n < names.size(); ++n) names[n] = int(n);
    std::shuffle(names.begin(), names.end(), std::mt19937(7));
    std::filesystem::create_directories(folder);
    for (int k = 0; k < sample.dims.z(); ++k)
        writeDicomFile(folder / (std::string("I") + std::to_string(names[size_t(k)] * 10)),
                       sliceOf(sample, k));
}

SampleVolume nineSlices() {
    SampleVolume sample;
    sample.dims.z() = 9;
    return sample;
}

TEST(Dicom, slicesAreOrderedByPlaceAlongTheNormal) {
    const test::TemporaryFolder folder;
    SampleVolume sample = nineSlices();
    sample.directions = Eigen::AngleAxisd(0.4, Eigen::Vector3d(3, 1, 2).normalized()).toRotationMatrix();
    writeSeries(folder.path(), sample);
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder.path()), sample, 1e-8));
}

// Feet first, sagittal and a stack that was acquired downwards all end as one right-handed grid.
TEST(Dicom, anyOrientationBecomesRightHanded) {
    const test::TemporaryFolder folder;
    int number = 0;
    for (const Eigen::Vector3d& normal :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0)}) {
        SampleVolume sample = nineSlices();
        const Eigen::Vector3d row = normal.x() == 0 ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(0, 1, 0);
        sample.directions << row, normal.cross(row), normal;
        for (const double order : {1.0, -1.0}) {
            sample.directions.col(2) = order * normal;
            const auto series = folder / (std::string("s") + std::to_string(number++));
            writeSeries(series, sample);
            const RawVolume raw = importVolume(series);
            EXPECT_NO_THROW(expectSamePlaces(raw, sample, 1e-9));
            EXPECT_NEAR(raw.geometry.X_WV.rotation.toRotationMatrix().determinant(), 1, 1e-12);
        }
    }
}

TEST(Dicom, storedValuesBecomeHounsfield) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    for (int k = 0; k < 3; ++k) {
        DicomImage image = sliceOf(sample, k);
        image.slope = 2;
        image.intercept = -1024;
        writeDicomFile(folder / std::to_string(k), image);
    }
    const RawVolume raw = importVolume(folder.path());
    const auto stored = sample.values();
    for (size_t n = 0; n < stored.size(); ++n) EXPECT_EQ(raw.values[n], 2.0f * stored[n] - 1024);
    EXPECT_TRUE(raw.is_hounsfield);
}

TEST(Dicom, filesThatAreNoImagesAreLeftOutAndNamed) {
    const test::TemporaryFolder folder;
    writeSeries(folder.path(), nineSlices());
    writeBytes(folder / "readme.txt", "not DICOM");
    DicomImage report;
    report.has_pixels = false;
    writeDicomFile(folder / "DICOMDIR", report);
    const RawVolume raw = importVolume(folder.path());
    EXPECT_NO_THROW(expectSamePlaces(raw, nineSlices()));
    EXPECT_NE(raw.description.find("readme.txt"), std::string::npos) << raw.description;
    EXPECT_NE(raw.description.find("DICOMDIR"), std::string::npos) << raw.description;
}

TEST(Dicom, largestSeriesIsTakenUnlessOneIsNamed) {
    const test::TemporaryFolder folder;
    writeSeries(folder / "large", nineSlices());
    const SampleVolume small;
    for (int k = 0; k < 3; ++k) {
        DicomImage image = sliceOf(small, k);
        image.series_uid = "9.8.7";
        writeDicomFile(folder / ("small" + std::to_string(k)), image);
    }
    const RawVolume largest = importVolume(folder.path());
    EXPECT_EQ(largest.geometry.dims.z(), 9);
    EXPECT_NE(largest.description.find("9.8.7"), std::string::npos) << largest.description;
    EXPECT_EQ(importVolume(folder.path(), {.series_uid = "9.8.7"}).geometry.dims.z(), 3);
    expectUserError([&] { importVolume(folder.path(), {.series_uid = "5.5"}); }, {"5.5", "9.8.7", "1.2.3.4"});
}

TEST(Dicom, multiFrameFileIsOrderedByTheFramesPlaces) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    DicomImage image = sliceOf(sample, 0);
    image.pixels.clear();
    for (const int k : {2, 0, 1}) {  // acquired in any order
        const DicomImage slice = sliceOf(sample, k);
        image.frame_positions.push_back(slice.position);
        image.pixels.insert(image.pixels.end(), slice.pixels.begin(), slice.pixels.end());
    }
    writeDicomFile(folder / "a.dcm", image);
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder / "a.dcm"), sample));
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder.path()), sample));
}

TEST(DicomErrors, emptyFolderAndFolderOfText) {
    const test::TemporaryFolder folder;
    expectUserError([&] { importVolume(folder.path()); }, {folder.path().string(), "empty"});
    writeBytes(folder / "notes.txt", std::string(1000, 'x'));
    expectUserError([&] { importVolume(folder.path()); }, {"notes.txt", "not DICOM"});
}

TEST(DicomErrors, truncatedSliceIsNamed) {
    const test::TemporaryFolder folder;
    writeSeries(folder.path(), nineSlices());
    const std::string bytes = readBytes(folder / "I40");
    writeBytes(folder / "I40", bytes.substr(0, bytes.size() - 7));
    expectUserError([&] { importVolume(folder.path()); }, {"I40", "cut short"});
    writeBytes(folder / "I40", bytes.substr(0, 300));
    expectUserError([&] { importVolume(folder.path()); }, {"I40", "cut short"});
}

// The field of the sample is linear, so that every voxel between its slices is known.
void expectSameField(const RawVolume& raw, const SampleVolume& sample) {
    const Eigen::Matrix3d step = sample.directions * sample.spacing_mm.asDiagonal();
    const Eigen::Vector3d last = sample.dims.cast<double>().array() - 1;
    size_t at = 0, inside = 0;
    for (int k = 0; k < raw.geometry.dims.z(); ++k)
        for (int j = 0; j < raw.geometry.dims.y(); ++j)
            for (int i = 0; i < raw.geometry.dims.x(); ++i, ++at) {
                const Eigen::Vector3d p_mm =
                    1000 * (raw.geometry.X_WV * raw.geometry.spacing.cwiseProduct(Eigen::Vector3d(i, j, k)));
                const Eigen::Vector3d index = step.inverse() * (p_mm - sample.origin_mm);
                if (!((index.array() > -1e-3).all() && (index.array() < last.array() + 1e-3).all())) continue;
                ++inside;
                EXPECT_NEAR(raw.values[at], index.dot(Eigen::Vector3d(1, 10, 100)), 0.51)
                    << i << ' ' << j << ' ' << k;
            }
    EXPECT_GE(inside, size_t(last.prod()));
}

TEST(DicomMended, WhatAMissingSliceWouldHoldComesFromItsNeighbours) {
    const test::TemporaryFolder folder;
    const SampleVolume sample = nineSlices();
    for (int k = 0; k < 9; ++k)
        if (k != 4) writeDicomFile(folder / ("slice" + std::to_string(k)), sliceOf(sample, k));
    const RawVolume raw = importVolume(folder.path());
    EXPECT_EQ(raw.geometry.dims, sample.dims);
    EXPECT_NO_THROW(expectSamePlaces(raw, sample, 1e-8));
    EXPECT_NE(raw.description.find("resampled to a regular grid (slices 1.25 to 2.5 mm apart)"),
              std::string::npos)
        << raw.description;
}

TEST(DicomMended, CopiesOfASliceAreDroppedAndCounted) {
    const test::TemporaryFolder folder;
    const SampleVolume sample = nineSlices();
    for (int k = 0; k < 9; ++k) writeDicomFile(folder / ("slice" + std::to_string(k)), sliceOf(sample, k));
    writeDicomFile(folder / "copy", sliceOf(sample, 2));
    writeDicomFile(folder / "another", sliceOf(sample, 2));
    const RawVolume raw = importVolume(folder.path());
    EXPECT_NO_THROW(expectSamePlaces(raw, sample, 1e-8));
    EXPECT_NE(raw.description.find("2 copies of slices left out"), std::string::npos) << raw.description;
    DicomImage other = sliceOf(sample, 2);
    other.pixels.back() += 1;
    writeDicomFile(folder / "other", other);
    expectUserError([&] { importVolume(folder.path()); }, {"same place and differ", "other", "acquisitions"});
}

TEST(DicomMended, ATiltedGantrysSlicesAreMovedBackAbove) {
    const test::TemporaryFolder folder;
    SampleVolume sample = nineSlices();
    sample.directions.col(2) = Eigen::Vector3d(0, std::sin(0.2), std::cos(0.2));  // 11.46 degrees
    writeSeries(folder.path(), sample);
    const RawVolume raw = importVolume(folder.path());
    expectSameField(raw, sample);
    EXPECT_EQ(raw.geometry.dims.z(), 9);
    EXPECT_NEAR(raw.geometry.spacing.z(), 1.25e-3 * std::cos(0.2), 1e-9);
    EXPECT_NE(raw.description.find("gantry tilt of 11.46 degrees"), std::string::npos) << raw.description;
}

TEST(DicomMended, ATiltBackwardsWithAGapIsBoth) {
    const test::TemporaryFolder folder;
    SampleVolume sample = nineSlices();
    sample.directions.col(2) = Eigen::Vector3d(std::sin(0.1), -std::sin(0.15), 0);
    sample.directions(2, 2) = std::sqrt(1 - sample.directions.col(2).squaredNorm());
    for (int k = 0; k < 9; ++k)
        if (k != 3) writeDicomFile(folder / ("slice" + std::to_string(k)), sliceOf(sample, k));
    const RawVolume raw = importVolume(folder.path());
    expectSameField(raw, sample);
    EXPECT_NE(raw.description.find("gantry tilt of"), std::string::npos) << raw.description;
    EXPECT_NE(raw.description.find("mm apart"), std::string::npos) << raw.description;
}

TEST(DicomErrors, colourIsRefused) {
    for (const char* photometric : {"RGB", "PALETTE COLOR"}) {
        const test::TemporaryFolder folder;
        for (int k = 0; k < 3; ++k) {
            DicomImage image = sliceOf(SampleVolume(), k);
            image.photometric = photometric;
            image.bits = 8;
            image.samples_per_pixel = image.photometric == "RGB" ? 3 : 1;
            image.pixels.assign(size_t(image.rows * image.columns * image.samples_per_pixel), 7);
            writeDicomFile(folder / ("colour" + std::to_string(k)), image);
        }
        expectUserError([&] { importVolume(folder.path()); }, {"3 colour images", "colour0"});
    }
}

TEST(DicomErrors, singleSliceIsNoVolume) {
    const test::TemporaryFolder folder;
    writeDicomFile(folder / "only", sliceOf(SampleVolume(), 0));
    expectUserError([&] { importVolume(folder.path()); }, {"2 or more slices", "only"});
}

TEST(DicomErrors, sliceWithoutPositionIsRefused) {
    const test::TemporaryFolder folder;
    for (int k = 0; k < 3; ++k) {
        DicomImage image = sliceOf(SampleVolume(), k);
        image.position.clear();
        writeDicomFile(folder / ("scan" + std::to_string(k)), image);
    }
    expectUserError([&] { importVolume(folder.path()); }, {"without a position", "scan0"});
}

TEST(Dicom, whatWasDrawnOnAScanIsRefusedWithAWayOut) {
    const test::TemporaryFolder folder;
    DicomImage drawn = sliceOf(SampleVolume(), 0);
    for (const char* const kind : {"66.5", "66.7", "481.3"})
        for (const bool has_pixels : {true, false}) {
            drawn.sop_class = std::string("1.2.840.10008.5.1.4.1.1.") + kind;
            drawn.has_pixels = has_pixels;
            writeDicomFile(folder / "a.dcm", drawn);
            expectUserError([&] { importVolume(folder / "a.dcm"); },
                            {"a.dcm", "RTSTRUCT", "3D Slicer", ".seg.nrrd or NIfTI"});
        }
    for (int k = 0; k < 3; ++k)
        writeDicomFile(folder / ("scan" + std::to_string(k)), sliceOf(SampleVolume(), k));
    const RawVolume raw = importVolume(folder.path());
    EXPECT_EQ(raw.geometry.dims.z(), 3) << "beside a scan it is left out";
    EXPECT_NE(raw.description.find("RTSTRUCT"), std::string::npos) << raw.description;
}

TEST(DicomScanTest, tellsKindsApart) {
    const test::TemporaryFolder folder;
    const DicomImage image = sliceOf(SampleVolume(), 0);
    writeDicomFile(folder / "image", image);
    EXPECT_EQ(scanDicomFile(folder / "image").kind, DicomKind::kImage);
    DicomImage report = image;
    report.has_pixels = false;
    writeDicomFile(folder / "report", report);
    EXPECT_EQ(scanDicomFile(folder / "report").kind, DicomKind::kNoImage);
    writeBytes(folder / "text", "hello");
    EXPECT_EQ(scanDicomFile(folder / "text").kind, DicomKind::kNotDicom);
    writeBytes(folder / "empty", "");
    EXPECT_EQ(scanDicomFile(folder / "empty").kind, DicomKind::kNotDicom);
    const std::string bytes = dicomBytes(image);
    for (size_t size = 200; size + 1 < bytes.size(); size += 13) {
        writeBytes(folder / "cut", bytes.substr(0, size));
        const DicomKind kind = scanDicomFile(folder / "cut").kind;
        EXPECT_TRUE(kind == DicomKind::kCutShort || kind == DicomKind::kNoImage)
            << size;  // cut between two elements
    }
}

}  // namespace
}  // namespace bonemill
