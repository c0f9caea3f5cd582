// The reader without ITK comes to what ITK's comes to, for all files that it takes.
#include <gtest/gtest.h>

#include "haptic_server/scans/formats/volume_file.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/seg_nrrd.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

void expectAsByItk(const std::filesystem::path& path) {
    SCOPED_TRACE(path);
    const RawVolume raw = readPlainNrrd(path, {}), itk = importNrrd(path);
    EXPECT_TRUE(raw.values == itk.values);
    EXPECT_EQ(raw.values.type(), itk.values.type());
    EXPECT_EQ(raw.geometry.dims, itk.geometry.dims);
    EXPECT_TRUE(raw.geometry.spacing.isApprox(itk.geometry.spacing, 1e-12));
    EXPECT_TRUE(raw.geometry.X_WV.position.isApprox(itk.geometry.X_WV.position, 1e-12));
    EXPECT_TRUE(raw.geometry.X_WV.rotation.isApprox(itk.geometry.X_WV.rotation, 1e-12));
    EXPECT_EQ(raw.lacks_patient_axes, itk.lacks_patient_axes);
    ASSERT_EQ(raw.segments.list.size(), itk.segments.list.size());
    for (size_t n = 0; n < raw.segments.list.size(); ++n)
        EXPECT_EQ(raw.segments.list[n].name, itk.segments.list[n].name);
}

TEST(PlainNrrd, EveryStorageSpaceAndHandedness) {
    const test::TemporaryFolder folder;
    for (const bool is_compressed : {false, true})
        for (const bool is_big_endian : {false, true})
            for (const bool is_left_handed : {false, true})
                for (const char* const space :
                     {"left-posterior-superior", "right-anterior-superior", "scanner-xyz"}) {
                    SCOPED_TRACE(space);
                    SampleVolume sample;
                    sample.directions << 0, 0, 1, 1, 0, 0, 0, is_left_handed ? -1 : 1, 0;
                    writeNrrdFile(folder / "a.nrrd", sample, {is_compressed, is_big_endian, false}, space);
                    expectAsByItk(folder / "a.nrrd");
                }
}

TEST(PlainNrrd, EveryTypeThatItTakes) {
    const test::TemporaryFolder folder;
    const auto write = [&](const std::string& type, const auto sample) {
        std::string bytes = "NRRD0001\ntype: " + type +
                            "\ndimension: 3\nsizes: 2 2 2\nspacings: 0.5 0.75 1.25\nendian: little\n"
                            "encoding: raw\n\n";
        for (int n = 0; n < 8; ++n) {
            const auto value = decltype(sample)(sample * n);
            bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        }
        writeBytes(folder / "a.nrrd", bytes);
        expectAsByItk(folder / "a.nrrd");
    };
    write("signed char", int8_t(-3));
    write("uchar", uint8_t(30));
    write("short", int16_t(-300));
    write("unsigned short", uint16_t(9000));
    write("int", int32_t(-70000));
    write("uint32", uint32_t(70000));
    write("float", 0.37f);
    write("double", 0.37);
}

TEST(PlainNrrd, OwnFilesComeBackBitForBit) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {4, 3, 2};
    geometry.spacing = {1.0 / 3e3, 1.0 / 7e3, 1.0 / 9e3};
    geometry.X_WV.position = {0.1 / 3, 0.1 / 7, -0.1 / 9};
    geometry.X_WV.rotation = Eigen::Quaterniond(0.3, 0.4, -0.5, 0.6).normalized();
    writeNrrd(folder / "a.nrrd", geometry, std::span<const float>(std::vector<float>(24, 0.25f)));
    const RawVolume raw = readPlainNrrd(folder / "a.nrrd", {});
    EXPECT_EQ(raw.geometry.spacing, geometry.spacing);
    EXPECT_EQ(raw.geometry.X_WV.position, geometry.X_WV.position);
    EXPECT_EQ(raw.geometry.X_WV.rotation.coeffs(), geometry.X_WV.rotation.coeffs());
}

TEST(PlainNrrd, SegmentsOfALabelMap) {
    const test::TemporaryFolder folder;
    writeSegNrrd(folder / "a.seg.nrrd",
                 {.segments = segmentLines(0, "bone", 1, 0) + segmentLines(1, "nerve", 2, 0),
                  .label = [](const Eigen::Vector3i& v, int) { return v.x() % 3; }});
    expectAsByItk(folder / "a.seg.nrrd");
}

TEST(PlainNrrd, WhatItDoesNotTakeIsSaidInOneLine) {
    const test::TemporaryFolder folder;
    const auto refuses = [&](std::initializer_list<std::string> words) {
        expectUserError([&] { readPlainNrrd(folder / "a.nrrd", {}); }, words);
    };
    writeNrrdFile(folder / "a.nrrd", SampleVolume(), {false, false, true});
    refuses({"a.nrrd", "BONEMILL_WITH_SCANS"});
    writeSegNrrd(folder / "a.nrrd", {.layers = 2, .label = [](const Eigen::Vector3i&, int) { return 0; }});
    refuses({"a.nrrd", "three axes", "BONEMILL_WITH_SCANS"});
    writeNrrdFile(folder / "a.nrrd", SampleVolume(), {});
    const std::string bytes = readBytes(folder / "a.nrrd");
    writeBytes(folder / "a.nrrd", bytes.substr(0, bytes.size() - 1));
    refuses({"a.nrrd", "cut short"});
}

}  // namespace
}  // namespace bonemill
