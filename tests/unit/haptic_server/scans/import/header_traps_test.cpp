// Headers that libraries read otherwise than they are meant, or trust too far, are read rightly or refused.
#include <gtest/gtest.h>

#include <cstring>

#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

class HeaderTraps : public ::testing::Test {
  protected:
    void expectRefused(const std::string& name, const std::string& bytes,
                       std::initializer_list<std::string> words) {
        writeBytes(folder_ / name, bytes);
        SCOPED_TRACE(bytes.substr(0, 400));
        expectUserError([&] { importVolume(folder_ / name); }, words);
    }
    void expectRead(const std::string& name, const std::string& bytes, const SampleVolume& meant,
                    double tolerance = 1e-9) {
        writeBytes(folder_ / name, bytes);
        SCOPED_TRACE(bytes.substr(0, 400));
        EXPECT_NO_THROW(expectSamePlaces(importVolume(folder_ / name), meant, tolerance));
    }
    std::string metaBytes(const Storage& storage = {}) {
        writeMetaImageFile(folder_ / "sample.mha", SampleVolume(), storage);
        return readBytes(folder_ / "sample.mha");
    }
    std::string nrrdBytes() {
        writeNrrdFile(folder_ / "sample.nrrd", SampleVolume(), {});
        return readBytes(folder_ / "sample.nrrd");
    }
    std::string niftiBytes() {
        writeNiftiFile(folder_ / "sample.nii", SampleVolume(), {});
        return readBytes(folder_ / "sample.nii");
    }
    void makeSparse(const std::string& name, uintmax_t bytes) {
        writeBytes(folder_ / name, "");
        std::filesystem::resize_file(folder_ / name, bytes);
    }

    test::TemporaryFolder folder_;
};

// The line goes before the one that ends a MetaImage's header.
std::string withLine(const std::string& bytes, const std::string& line) {
    return replaced(bytes, "DimSize", line + "\nDimSize");
}

SampleVolume scaledSample(double factor) {
    SampleVolume sample;
    sample.spacing_mm *= factor;
    sample.origin_mm *= factor;
    return sample;
}

using MetaImageTraps = HeaderTraps;

TEST_F(MetaImageTraps, listsAndPatternsOfFilesAreRefused) {
    for (const char* data : {"LIST\na.raw\n", "LIST 2\n", "a%02d.raw 1 3 1\n"})
        expectRefused("a.mhd", replaced(metaBytes(), "LOCAL\n", data), {"a.mhd", "several files"});
}

TEST_F(MetaImageTraps, voxelsAsTextAreRefused) {
    expectRefused("a.mha", replaced(metaBytes(), "BinaryData = True", "BinaryData = False"),
                  {"a.mha", "BinaryData"});
    expectRefused("a.mha", replaced(metaBytes(), "BinaryData = True\n", ""), {"a.mha", "BinaryData"});
}

TEST_F(MetaImageTraps, aForeignHeaderBeforeTheVoxelsIsRefused) {
    for (const char* size : {"HeaderSize = 16", "HeaderSize = -1", "HeaderSize = 0.5"})
        expectRefused("a.mha", withLine(metaBytes(), size), {"a.mha", "HeaderSize"});
    expectRead("a.mha", withLine(metaBytes(), "HeaderSize = 0"), SampleVolume());
}

TEST_F(MetaImageTraps, compressedVoxelsNeedTheirSize) {
    const std::string bytes = metaBytes({.is_compressed = true});
    const size_t begin = bytes.find("CompressedDataSize"), end = bytes.find('\n', begin) + 1;
    expectRefused("a.mha", std::string(bytes).erase(begin, end - begin), {"a.mha", "CompressedDataSize"});
    for (const char* size : {"0", "-5", "nan"})
        expectRefused("a.mha",
                      std::string(bytes).replace(begin, end - begin,
                                                 "CompressedDataSize = " + std::string(size) + "\n"),
                      {"a.mha", "CompressedDataSize"});
}

// The library reads no further either, and would leave what is missing as it finds it.
TEST_F(MetaImageTraps, compressedVoxelsEndWhereTheirSizeSays) {
    const std::string bytes = metaBytes({.is_compressed = true});
    const size_t begin = bytes.find("CompressedDataSize"), end = bytes.find('\n', begin) + 1;
    expectRefused("a.mha", std::string(bytes).replace(begin, end - begin, "CompressedDataSize = 40\n"),
                  {"a.mha", "cut short"});
}

TEST_F(MetaImageTraps, unitsOfLengthAreHonoured) {
    for (const auto& [unit, factor] :
         {std::pair("um", 1e-3), std::pair("mm", 1.0), std::pair("cm", 10.0), std::pair("?", 1.0)})
        expectRead("a.mha", withLine(metaBytes(), std::string("DistanceUnits = ") + unit),
                   scaledSample(factor));
    expectRefused("a.mha", withLine(metaBytes(), "DistanceUnits = ell"), {"a.mha", "DistanceUnits", "mm"});
}

TEST_F(MetaImageTraps, scaledVoxelsAreRefused) {
    expectRefused("a.mha", withLine(metaBytes(), "ElementToIntensityFunctionSlope = 2"),
                  {"a.mha", "ElementToIntensityFunctionSlope"});
    expectRefused("a.mha", withLine(metaBytes(), "ElementToIntensityFunctionOffset = -1024"),
                  {"a.mha", "ElementToIntensityFunctionOffset"});
    expectRead(
        "a.mha",
        withLine(metaBytes(), "ElementToIntensityFunctionSlope = 1\nElementToIntensityFunctionOffset = 0"),
        SampleVolume());
}

// The library parts names and values by colons, too, and takes one of two values of a name.
TEST_F(MetaImageTraps, whatTheLibraryWouldReadOtherwiseIsRefused) {
    expectRefused("a.mha", withLine(metaBytes(), "BinaryData: False ="), {"a.mha", "BinaryData: False"});
    expectRefused("a.mha", withLine(metaBytes(), "ElementSpacing = 1 1 1\nElementSpacing = 2 2 2"),
                  {"a.mha", "ElementSpacing", "twice"});
}

TEST_F(MetaImageTraps, anEndlessLineIsNotReadToItsEnd) {
    makeSparse("a.mha", uintmax_t(1) << 40);
    expectUserError([&] { importVolume(folder_ / "a.mha"); }, {"a.mha", "is not a MetaImage"});
}

using NrrdTraps = HeaderTraps;

TEST_F(NrrdTraps, listsAndPatternsOfFilesAreRefused) {
    const std::string header = replaced(nrrdBytes(), "\n\n", "\n");
    const std::string text = header.substr(0, header.find("raw\n") + 4);
    for (const char* data : {"LIST\na.raw\n", "LIST 2\na.raw\n", "a%02d.raw 1 3 1\n"})
        expectRefused("a.nhdr", text + "data file: " + data, {"a.nhdr", "several files"});
}

TEST_F(NrrdTraps, anEndlessLineIsNotReadToItsEnd) {
    makeSparse("a.nrrd", uintmax_t(1) << 40);
    expectUserError([&] { importVolume(folder_ / "a.nrrd"); }, {"a.nrrd", "is not a NRRD file"});
    writeBytes(folder_ / "b.nrrd", "NRRD0004\ntype: short\ncontent: ");
    std::filesystem::resize_file(folder_ / "b.nrrd", uintmax_t(1) << 40);
    expectUserError([&] { importVolume(folder_ / "b.nrrd"); }, {"b.nrrd", "does not end"});
}

TEST_F(NrrdTraps, unequalUnitsAreRefused) {
    for (const char* line : {"space units: \"mm\" \"mm\" \"cm\"\n", "units: \"mm\" \"cm\" \"mm\"\n"})
        expectRefused("a.nrrd", replaced(nrrdBytes(), "endian:", line + std::string("endian:")),
                      {"a.nrrd", "units", "differ"});
}

TEST_F(NrrdTraps, unitsOfAxesDoNotReplaceThoseOfSpace) {
    const std::string space = "space units: \"cm\" \"cm\" \"cm\"\n", axes = "units: \"\" \"\" \"\"\n";
    for (const std::string& lines : {space + axes, axes + space})
        expectRead("a.nrrd", replaced(nrrdBytes(), "endian:", lines + "endian:"), scaledSample(10));
}

TEST_F(NrrdTraps, unitsOfAxesAreTakenWithoutASpace) {
    SampleVolume meant = scaledSample(10);
    meant.origin_mm.setZero();
    const std::string bytes = nrrdBytes();
    expectRead("a.nrrd",
               "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nspacings: 0.5 0.75 1.25\n"
               "units: \"cm\" \"cm\" \"cm\"\nendian: little\nencoding: raw\n\n" +
                   bytes.substr(bytes.find("\n\n") + 2),
               meant);
}

TEST_F(NrrdTraps, aGeometryOfOursWithImpossibleSpacingIsIgnored) {
    // Both name the same places: two axes point the other way, by as much less than nothing.
    VolumeGeometry geometry;
    geometry.dims = {5, 4, 3};
    geometry.spacing = Eigen::Vector3d(-0.5, -0.75, 1.25) / 1000;
    geometry.X_WV.position = Eigen::Vector3d(10, -20, 30) / 1000;
    geometry.X_WV.rotation = Eigen::Quaterniond(0, 0, 0, 1);
    const std::string line = std::string(kNrrdGeometryKey) + ":=" + geometryToText(geometry) + "\n";
    writeBytes(folder_ / "a.nrrd", replaced(nrrdBytes(), "endian:", line + "endian:"));
    const RawVolume raw = importVolume(folder_ / "a.nrrd");
    EXPECT_GT(raw.geometry.spacing.minCoeff(), 0);
    EXPECT_NO_THROW(expectSamePlaces(raw, SampleVolume()));
    for (const char* number : {"0", "-0x1p-3", "inf", "nan"})
        EXPECT_FALSE(geometryFromText(std::string("5 4 3 ") + number + " 1 1 0 0 0 1 0 0 0")) << number;
}

using NiftiTraps = HeaderTraps;

std::string withFloat(std::string bytes, size_t offset, float value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
}

constexpr size_t kSlope = 112, kIntercept = 116, kPixdim = 80, kSformCode = 254;

TEST_F(NiftiTraps, anInterceptWithoutASlopeIsRefused) {
    const std::string unscaled = withFloat(niftiBytes(), kSlope, 0);
    expectRead("a.nii", unscaled, SampleVolume(), 1e-8);
    expectRefused("a.nii", withFloat(unscaled, kIntercept, -1024), {"a.nii", "scl_slope", "scl_inter"});
    expectRefused("a.nii", withFloat(niftiBytes(), kSlope, 1e-20f), {"a.nii", "scl_slope"});
}

TEST_F(NiftiTraps, aVoxelOfNoSizeIsRefused) {
    for (const float size : {0.0f, -0.5f}) {
        const std::string bytes = withFloat(niftiBytes(), kPixdim, size);
        expectRefused("a.nii", bytes, {"a.nii", "pixdim"});  // the library refuses it unclearly
        std::string without = bytes;
        std::fill_n(without.begin() + kSformCode - 2, 4, '\0');
        expectRefused("a.nii", without, {"a.nii", "pixdim"});
        without[kSformCode - 2] = 1;  // qform_code
        expectRefused("a.nii", without, {"a.nii", "pixdim"});
    }
}

}  // namespace
}  // namespace bonemill
