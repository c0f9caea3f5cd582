// DICOM segmentations: written byte by byte, read by the library and compared to what they were made of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/scans/dicom/dicom_segments.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/labels/labels.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/dicom_seg_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using Frame = DicomSegmentation::Frame;
using IsIn = std::function<bool(int segment, const Eigen::Vector3d& p_mm)>;

std::string decimals(const Eigen::Vector3d& v) {
    char text[80];
    std::snprintf(text, sizeof text, "%.9g\\%.9g\\%.9g", v.x(), v.y(), v.z());
    return text;
}

// Slices of pixels of 0.5 x 0.75 mm, 2 mm apart, that may be shifted along their rows.
struct DrawnOn {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // row, column, normal
    Eigen::Vector3d origin_mm{10, -20, 30};
    double shift_mm = 0;  // per slice
    int rows = 12, columns = 10;

    Eigen::Vector3d first(int slice) const {
        return origin_mm + axes * Eigen::Vector3d(shift_mm * slice, 0, 2.0 * slice);
    }
    Eigen::Vector3d place(int slice, int row, int column) const {
        return first(slice) + axes * Eigen::Vector3d(0.5 * column, 0.75 * row, 0);
    }
    Frame frame(int segment, int slice, const IsIn& is_in, int value = 1) const {
        Frame frame{segment, decimals(first(slice)), {}};
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                frame.values.push_back(is_in(segment, place(slice, row, column)) ? uint8_t(value) : 0);
        return frame;
    }
    DicomSegmentation file() const {
        return {.rows = rows,
                .columns = columns,
                .orientation = decimals(axes.col(0)) + "\\" + decimals(axes.col(1)),
                .pixel_spacing = "0.75\\0.5",
                .spacing_between = "2",
                .segments = {{5, "facial nerve"}, {2, "canal"}},
                .frames = {}};
    }
};

class DicomSeg : public testing::Test {
  protected:
    RawVolume imported(const DicomSegmentation& file) const {
        writeDicomSeg(folder_ / "a.dcm", file);
        return importVolume(folder_ / "a.dcm");
    }
    void expectRefused(const DicomSegmentation& file, std::initializer_list<std::string> words) const {
        expectUserError([&] { imported(file); }, words);
    }
    static bool isOf(const RawVolume& raw, const Eigen::Vector3i& v, const std::string& name) {
        const auto labels = labelsOfSegment(raw.segments, name, "f");
        const Eigen::Vector3i& dims = raw.geometry.dims;
        const auto value = uint32_t(raw.values[size_t(v.x() + dims.x() * (v.y() + dims.y() * v.z()))]);
        return std::ranges::find(labels, value) != labels.end();
    }
    // Where the truth changes within `border_mm`, either may be right.
    static void expectTruth(const RawVolume& raw,
                            const std::function<double(const Eigen::Vector3d&)>& outside,
                            const std::string& name, double border_mm) {
        size_t count = 0;
        forEachIndex({Eigen::Vector3i::Zero(), raw.geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            const double distance =
                outside(1e3 * (raw.geometry.X_WV *
                               Eigen::Vector3d(raw.geometry.spacing.cwiseProduct(v.cast<double>()))));
            count += distance < 0;
            if (std::abs(distance) <= border_mm) return;
            ASSERT_EQ(isOf(raw, v, name), distance < 0) << v.transpose() << ", " << distance << " mm";
        });
        EXPECT_GT(count, 50u);
    }
    // Two segments on three slices.
    static DicomSegmentation plainFile() {
        const DrawnOn drawn;
        DicomSegmentation file = drawn.file();
        const IsIn is_in = [](int segment, const Eigen::Vector3d& p) { return segment == 5 && p.x() > 12; };
        for (const int slice : {0, 1, 2}) file.frames.push_back(drawn.frame(5, slice, is_in));
        return file;
    }

    test::TemporaryFolder folder_;
};

TEST_F(DicomSeg, hasTheNamesNumbersAndColoursOfItsSegments) {
    DicomSegmentation file = plainFile();
    file.segments[0].lab = {32768, 65535 * 128 / 255, 65535 * 128 / 255};
    const RawVolume raw = imported(file);
    ASSERT_EQ(raw.segments.list.size(), 2u);
    EXPECT_FALSE(raw.segments.are_layered);
    EXPECT_EQ(raw.segments.list[0].name, "facial nerve");
    EXPECT_EQ(raw.segments.list[0].labels, std::vector<uint32_t>{5});
    ASSERT_TRUE(raw.segments.list[0].color);
    EXPECT_TRUE(raw.segments.list[0].color->isConstant(0.466, 0.005)) << "L* 50 is a grey of 119";
    EXPECT_EQ(raw.segments.list[1].labels, std::vector<uint32_t>{2});
    EXPECT_FALSE(raw.segments.list[1].color);
    EXPECT_EQ(raw.geometry.dims, Eigen::Vector3i(10, 12, 3));
    EXPECT_TRUE(raw.geometry.spacing.isApprox(Eigen::Vector3d(0.5, 0.75, 2) * 1e-3));
    EXPECT_EQ(raw.values[9], 5) << "voxels have the segment's number";
    EXPECT_EQ(raw.values[0], 0);
    EXPECT_NE(raw.description.find("DICOM SEG (BINARY), 2 segments in 3 frames"), std::string::npos)
        << raw.description;
}

// An oblique ellipsoid, of which slices 1, 2 and 4 to 7 are written, in another order.
TEST_F(DicomSeg, liesWhereItWasDrawnOnSlantedAndMissingSlices) {
    DrawnOn drawn;
    drawn.axes = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    const Eigen::Vector3d middle = drawn.place(4, 6, 5);
    const auto outside = [&](const Eigen::Vector3d& p) {
        return (p - middle).cwiseQuotient(Eigen::Vector3d(2, 3.5, 5)).norm() - 1;
    };
    const IsIn is_in = [&](int, const Eigen::Vector3d& p) { return outside(p) < 0; };
    for (const bool says_step : {true, false}) {
        DicomSegmentation file = drawn.file();
        if (!says_step) file.spacing_between.clear();
        for (const int slice : {6, 1, 4, 7, 2, 5}) file.frames.push_back(drawn.frame(2, slice, is_in));
        const RawVolume raw = imported(file);
        EXPECT_EQ(raw.geometry.dims.z(), 7);
        EXPECT_NEAR(raw.geometry.spacing.z(), 2e-3, 1e-8);
        const auto of_written = [&](const Eigen::Vector3d& p) {
            const double slice = (p - drawn.origin_mm).dot(drawn.axes.col(2)) / 2;
            return std::abs(slice - 3) < 0.1 ? 1.0 : outside(p);
        };
        expectTruth(raw, of_written, "canal", 1e-6);
    }
}

TEST_F(DicomSeg, ofATiltedGantryLiesAtTheNearestPixels) {
    DrawnOn drawn;
    drawn.shift_mm = -0.7;
    const Eigen::Vector3d middle = drawn.place(3, 6, 5);
    const auto outside = [&](const Eigen::Vector3d& p) { return (p - middle).norm() - 3.5; };
    DicomSegmentation file = drawn.file();
    for (int slice = 0; slice < 7; ++slice)
        file.frames.push_back(
            drawn.frame(5, slice, [&](int, const Eigen::Vector3d& p) { return outside(p) < 0; }));
    const RawVolume raw = imported(file);
    EXPECT_GT(raw.geometry.dims.x(), 10);
    EXPECT_EQ(raw.geometry.dims.z(), 7);
    EXPECT_NE(raw.description.find("shifted sideways"), std::string::npos) << raw.description;
    const auto within_frames = [&](const Eigen::Vector3d& p) {
        const int slice = int(std::lround((p - drawn.origin_mm).z() / 2));
        const double column = (p - drawn.first(slice)).x() / 0.5;
        return column < -0.5 || column > 9.5 ? 0.0 : outside(p);  // nobody drew there
    };
    expectTruth(raw, within_frames, "facial nerve", 0.25);
}

TEST_F(DicomSeg, overlapsAndNumbersTheCombinations) {
    const DrawnOn drawn;
    const IsIn is_in = [](int segment, const Eigen::Vector3d& p) {
        return segment == 5 ? p.x() > 11.9 && p.x() < 13.1 : p.y() > -17;
    };
    DicomSegmentation file = drawn.file();
    for (const int slice : {0, 1}) {
        file.frames.push_back(drawn.frame(5, slice, is_in));
        file.frames.push_back(drawn.frame(2, slice, is_in));
    }
    const RawVolume raw = imported(file);
    EXPECT_TRUE(raw.segments.are_layered);
    EXPECT_EQ(labelsOfSegment(raw.segments, "canal", "f").size(), 2u) << "alone, and with the nerve";
    forEachIndex({{0, 0, 0}, {9, 11, 1}}, [&](const Eigen::Vector3i& v) {
        const Eigen::Vector3d p = drawn.place(v.z(), v.y(), v.x());
        EXPECT_EQ(isOf(raw, v, "facial nerve"), is_in(5, p)) << v.transpose();
        EXPECT_EQ(isOf(raw, v, "canal"), is_in(2, p)) << v.transpose();
    });
}

TEST_F(DicomSeg, ofFractionsCountsFromHalfOn) {
    DicomSegmentation file = plainFile();
    file.type = "FRACTIONAL";
    file.most_fraction = 101;
    file.frames[0].values.assign(120, 50);
    file.frames[1].values.assign(120, 51);
    file.frames[2].values.assign(120, 101);
    const RawVolume raw = imported(file);
    EXPECT_EQ(raw.values[0], 0);
    EXPECT_EQ(raw.values[120], 5);
    EXPECT_EQ(raw.values[240], 5);
}

// As 3D Slicer's extension for DICOM packs them.
TEST_F(DicomSeg, mayBeDeflated) {
    DicomSegmentation file = plainFile();
    file.transfer_syntax = "1.2.840.10008.1.2.1.99";
    const RawVolume raw = imported(file), plain = imported(plainFile());
    EXPECT_TRUE(raw.values == plain.values);
    EXPECT_EQ(raw.segments.list[0].name, "facial nerve");
    std::string bytes = dicomSegBytes(file);
    writeBytes(folder_ / "cut.dcm", bytes.substr(0, bytes.size() - 100));
    expectUserError([&] { importVolume(folder_ / "cut.dcm"); }, {"cut.dcm"});
}

TEST_F(DicomSeg, ofOneSliceIsAsThickAsItSays) {
    DicomSegmentation file = plainFile();
    file.frames.resize(1);
    EXPECT_EQ(imported(file).geometry.dims.z(), 2) << "the second one is empty";
    file.spacing_between.clear();
    expectRefused(file, {"a.dcm", "one slice", "3D Slicer"});
    file.thickness = "1.5";
    EXPECT_NEAR(imported(file).geometry.spacing.z(), 1.5e-3, 1e-9);
}

// A micrometre is no step, whichever of the frames comes first.
TEST_F(DicomSeg, ofNearlyTheSamePlaceIsOneSlice) {
    DicomSegmentation file{.spacing_between = "2", .segments = {{1, "a"}, {2, "b"}, {3, "c"}}, .frames = {}};
    const std::vector<uint8_t> all(12, 1), left = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const std::vector<uint8_t> right = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    file.frames.push_back({2, "0\\0\\0", left});
    file.frames.push_back({1, "0\\0\\-1e-19", all});
    file.frames.push_back({3, "0\\0\\0.001", right});
    for (const char* const below : {"-2", "-4", "-6", "-8", "-10", "-12", "-14"})
        file.frames.push_back({1, std::string("0\\0\\") + below, all});
    const RawVolume raw = imported(file);
    ASSERT_EQ(raw.geometry.dims, Eigen::Vector3i(4, 3, 8));
    forEachIndex({Eigen::Vector3i::Zero(), {3, 2, 7}}, [&](const Eigen::Vector3i& v) {
        EXPECT_TRUE(isOf(raw, v, "a")) << v.transpose();
        EXPECT_EQ(isOf(raw, v, "b"), v.z() == 7 && v.x() == 0) << v.transpose();
        EXPECT_EQ(isOf(raw, v, "c"), v.z() == 7 && v.x() == 3) << v.transpose();
    });
}

// Each gap is a step or nearly so, and slices in the middle would lie three steps from where they are.
TEST_F(DicomSeg, whoseStepChangesIsRefused) {
    DicomSegmentation file{.spacing_between = "2", .segments = {{1, "a"}}, .frames = {}};
    double z = 0;
    for (int slice = 0; slice < 60; ++slice, z += slice < 30 ? 2.19 : 1.81)
        file.frames.push_back({1, decimals({0, 0, z}), std::vector<uint8_t>(12, 1)});
    expectRefused(file, {"a.dcm", "unevenly far apart"});
}

TEST_F(DicomSeg, hasNamesInUtf8) {
    DicomSegmentation file = plainFile();
    file.segments[0].label =
        "Sch\xe4"
        "del";
    file.character_set = "ISO_IR 100";
    EXPECT_EQ(imported(file).segments.list[0].name,
              "Sch\xc3\xa4"
              "del");
    file.character_set = "ISO_IR 101";
    EXPECT_EQ(imported(file).segments.list[0].name, "Sch?del");
    file.segments[0].label =
        "Sch\xc3\xa4"
        "del";
    file.character_set = "ISO_IR 192";
    EXPECT_EQ(imported(file).segments.list[0].name,
              "Sch\xc3\xa4"
              "del");
}

TEST_F(DicomSeg, ofAnotherKindIsRefusedWithAWayOut) {
    DicomSegmentation file = plainFile();
    file.type = "LABELMAP";
    expectRefused(file, {"a.dcm", "LABELMAP", "BINARY and FRACTIONAL", "3D Slicer", ".seg.nrrd"});
    file.type = "";
    expectRefused(file, {"a.dcm", "none that is known"});
    file = plainFile();
    file.transfer_syntax = "1.2.840.10008.1.2.5";
    expectRefused(file, {"a.dcm", "3D Slicer"});
    file = plainFile();
    file.bits = 8;
    expectRefused(file, {"a.dcm", "1 bit"});
    file.type = "FRACTIONAL";
    expectRefused(file, {"a.dcm", "Maximum Fractional Value"});
}

TEST_F(DicomSeg, thatDoesNotFitTogetherIsRefused) {
    const DicomSegmentation good = plainFile();
    const auto refused = [&](const std::function<void(DicomSegmentation&)>& spoil,
                             std::initializer_list<std::string> words) {
        DicomSegmentation file = good;
        spoil(file);
        expectRefused(file, words);
    };
    refused([](auto& f) { f.segments.clear(); }, {"a.dcm", "nothing of its segments"});
    refused([](auto& f) { f.segments[1].number = 5; }, {"its segment 2", "number"});
    refused([](auto& f) { f.segments[1].number.reset(); }, {"its segment 2", "number"});
    refused([](auto& f) { f.segments[1].number = 0; }, {"its segment 2", "number"});
    refused([](auto& f) { f.segments[0].label.clear(); }, {"segment 5", "64 bytes"});
    refused([](auto& f) { f.segments[0].label = "a\x1b[2J"; }, {"segment 5", "control characters"});
    refused([](auto& f) { f.segments[0].label.assign(65, 'a'); }, {"segment 5", "64 bytes"});
    refused([](auto& f) { f.segments.assign(257, {1, "a"}); }, {"more than 256 segments"});
    refused([](auto& f) { f.frames[1].segment = 3; }, {"frame 2", "no segment"});
    refused([](auto& f) { f.frames[1].segment.reset(); }, {"frame 2", "no segment"});
    refused([](auto& f) { f.frames[1].position.clear(); }, {"frame 2", "where in the patient"});
    refused([](auto& f) { f.frames[1].position = "a\\b\\c"; }, {"frame 2", "Image Position"});
    refused([](auto& f) { f.frames[1].position = f.frames[0].position; },
            {"frame 2", "second one of segment 5"});
    refused([](auto& f) { f.frames[1].position = "10\\-20\\33.3"; }, {"unevenly far apart"});
    refused([](auto& f) { f.frames[1].position = "10\\-20\\1e200"; }, {"a.dcm"});
    refused([](auto& f) { f.frames[1].position = "10\\-20\\900000"; }, {"unevenly far apart, or more than"});
    refused([](auto& f) { f.frames[1].position = "30\\-20\\32"; }, {"mm beside each other"});
    refused([](auto& f) { f.frames[1].orientation = "0\\1\\0\\0\\0\\1"; }, {"several directions"});
    refused([](auto& f) { f.pixel_spacing = "0\\0.5"; }, {"Pixel Spacing"});
    refused([](auto& f) { f.frames_said = 4; }, {"each of its frames"});
    refused([](auto& f) { f.frames.clear(); }, {"each of its frames"});
    refused([](auto& f) { f.missing_bytes = 2; }, {"promises"});
    refused([](auto& f) { f.rows = 0; }, {"no size"});
    refused([](auto& f) { f.rows = 60000; }, {"promises"});
    refused([](auto& f) { f.has_pixels = false; }, {"holds no pixels"});
}

// Each voxel of a row of its own combination: 2^13 of 13 segments.
TEST_F(DicomSeg, thatOverlapsInTooManyWaysIsRefused) {
    DicomSegmentation file{.rows = 64, .columns = 128, .spacing_between = "1", .segments = {}, .frames = {}};
    for (int segment = 1; segment <= 13; ++segment) {
        file.segments.push_back({segment, "s" + std::to_string(segment)});
        Frame frame{segment, "0\\0\\0", {}};
        for (int pixel = 0; pixel < 64 * 128; ++pixel)
            frame.values.push_back(uint8_t(pixel >> (segment - 1) & 1));
        file.frames.push_back(frame);
    }
    expectRefused(file, {"a.dcm", "too many ways"});
}

TEST_F(DicomSeg, isNoSliceOfAScan) {
    writeDicomSeg(folder_ / "a.dcm", plainFile());
    expectUserError([&] { importVolume(folder_.path()); }, {"segmentations (SEG)", "volume.label_path"});
}

TEST(LabColor, isThatOfThePureColours) {
    const auto stored = [](double lightness, double a, double b) {
        const auto scaled = [](double share) { return uint16_t(std::lround(share * 65535)); };
        return std::array<uint16_t, 3>{scaled(lightness / 100), scaled((a + 128) / 255),
                                       scaled((b + 128) / 255)};
    };
    // sRGB's primaries in CIELab of D50, as profiles of the ICC have them.
    EXPECT_TRUE(colorOfLab(stored(54.29, 80.81, 69.89)).isApprox(Eigen::Vector3d(1, 0, 0), 0.01));
    EXPECT_TRUE(colorOfLab(stored(87.82, -79.29, 80.99)).isApprox(Eigen::Vector3d(0, 1, 0), 0.01));
    EXPECT_TRUE(colorOfLab(stored(29.57, 68.30, -112.03)).isApprox(Eigen::Vector3d(0, 0, 1), 0.02));
    EXPECT_TRUE(colorOfLab(stored(100, 0, 0)).isApprox(Eigen::Vector3d::Ones(), 0.01));
    EXPECT_TRUE(colorOfLab(stored(0, 0, 0)).isZero(0.01));
}

}  // namespace
}  // namespace bonemill
