// Each bad input gives one clear message.
#include <gtest/gtest.h>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

class ImportErrors : public ::testing::Test {
  protected:
    // Imports the file with these bytes.
    void expectRefused(const std::string& name, const std::string& bytes,
                       std::initializer_list<std::string> words) {
        writeBytes(folder_ / name, bytes);
        expectUserError([&] { importVolume(folder_ / name); }, words);
    }
    std::string sampleBytes(const std::string& name) {
        const SampleVolume sample;
        if (name.ends_with(".nrrd")) writeNrrdFile(folder_ / name, sample, {});
        if (name.ends_with(".nii")) writeNiftiFile(folder_ / name, sample, {});
        if (name.ends_with(".mha")) writeMetaImageFile(folder_ / name, sample, {});
        return readBytes(folder_ / name);
    }
    test::TemporaryFolder folder_;
};

TEST_F(ImportErrors, missingFileIsNamed) {
    expectUserError([&] { importVolume(folder_ / "nothing.nrrd"); }, {"nothing.nrrd", "no such file"});
}

TEST_F(ImportErrors, unknownTypeListsTheKnownOnes) {
    expectRefused("bone.jpg", "x", {"bone.jpg", ".nrrd", ".nii.gz", ".mha", ".inv3", "DICOM"});
}

TEST_F(ImportErrors, textInsteadOfAnyFormat) {
    for (const char* name : {"a.nrrd", "a.nhdr", "a.nii", "a.nii.gz", "a.mha", "a.mhd", "a.inv3", "a.dcm"})
        expectRefused(name, "This is a shopping list: milk, bread, bone wax.\n", {name});
}

TEST_F(ImportErrors, emptyFileOfAnyFormat) {
    for (const char* name : {"a.nrrd", "a.nhdr", "a.nii", "a.nii.gz", "a.mha", "a.mhd", "a.inv3", "a.dcm"})
        expectRefused(name, "", {name});
}

TEST_F(ImportErrors, cutShortFileIsRefused) {
    for (const char* name : {"a.nrrd", "a.nii", "a.mha"}) {
        const std::string bytes = sampleBytes(name);
        expectRefused(name, bytes.substr(0, bytes.size() - 20), {name, "cut short"});
    }
}

TEST_F(ImportErrors, cutShortCompressedFileIsRefused) {
    const Storage compressed{.is_compressed = true};
    writeNrrdFile(folder_ / "a.nrrd", SampleVolume(), compressed);
    writeNiftiFile(folder_ / "a.nii.gz", SampleVolume(), compressed);
    writeMetaImageFile(folder_ / "a.mha", SampleVolume(), compressed);
    for (const char* name : {"a.nrrd", "a.nii.gz", "a.mha"}) {
        const std::string bytes = readBytes(folder_ / name);
        expectRefused(name, bytes.substr(0, bytes.size() - 20), {name});
    }
}

TEST_F(ImportErrors, missingDataFileIsRefused) {
    writeNrrdFile(folder_ / "a.nhdr", SampleVolume(), {.is_detached = true});
    writeMetaImageFile(folder_ / "b.mhd", SampleVolume(), {.is_detached = true});
    std::filesystem::remove(folder_ / "a.raw");
    std::filesystem::remove(folder_ / "b.raw");
    expectUserError([&] { importVolume(folder_ / "a.nhdr"); }, {"a.nhdr"});
    expectUserError([&] { importVolume(folder_ / "b.mhd"); }, {"b.raw", "no such file"});
}

TEST_F(ImportErrors, shearedAxesAreRefused) {
    SampleVolume sample;
    sample.directions(0, 2) = 0.1;  // what a tilted gantry gives
    sample.directions.col(2).normalize();
    writeNrrdFile(folder_ / "a.nrrd", sample, {});
    expectUserError([&] { importVolume(folder_ / "a.nrrd"); }, {"a.nrrd", "perpendicular"});
    writeMetaImageFile(folder_ / "a.mha", sample, {});
    expectUserError([&] { importVolume(folder_ / "a.mha"); }, {"a.mha"});
    writeNiftiFile(folder_ / "a.nii", sample, {});
    expectUserError([&] { importVolume(folder_ / "a.nii"); }, {"a.nii"});
}

TEST_F(ImportErrors, absurdSizesAreRefusedBeforeAnythingIsAllocated) {
    const std::string nrrd = sampleBytes("a.nrrd");
    expectRefused("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 50000 50000 50000"), {"a.nrrd", "2^31"});
    expectRefused("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 1000 1000 1000"), {"a.nrrd", "cut short"});
    const std::string meta = sampleBytes("a.mha");
    expectRefused("a.mha", replaced(meta, "DimSize = 5 4 3", "DimSize = 50000 50000 50000"),
                  {"a.mha", "2^31"});
}

TEST_F(ImportErrors, twoDimensionsAndVectorsAreRefused) {
    const std::string nrrd = sampleBytes("a.nrrd");
    expectRefused("a.nrrd",
                  "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 4 4\nencoding: raw\n\n0123456789abcdef",
                  {"a.nrrd", "2 dimensions"});
    expectRefused(
        "b.nrrd",
        "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 2 2\nkinds: RGB-color domain domain domain\n"
        "encoding: raw\n\n0123456789abcdef01234567",
        {"b.nrrd", "3 values per voxel"});
    expectRefused("c.nrrd",
                  "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 1\nencoding: raw\n\n0123456789abcdef",
                  {"c.nrrd", "2 or more"});
}

TEST_F(ImportErrors, zeroSpacingIsRefused) {
    const std::string meta = sampleBytes("a.mha");
    expectRefused("a.mha", replaced(meta, "ElementSpacing = 0.5", "ElementSpacing = 0"), {"a.mha"});
    const std::string nan = replaced(meta, "ElementSpacing = 0.5", "ElementSpacing = nan");
    expectRefused("a.mha", nan, {"a.mha"});
}

TEST_F(ImportErrors, voxelsBeyondAllBoundsAreRefused) {
    const std::string nrrd = sampleBytes("a.nrrd");
    const size_t begin = nrrd.find("space directions:"), end = nrrd.find('\n', begin);
    ASSERT_NE(end, std::string::npos);
    for (const char* length : {"1e300", "-1e300", "inf", "1e100", "1e5", "1e-7", "0"})
        expectRefused(
            "a.nrrd",
            std::string(nrrd).replace(begin, end - begin,
                                      "space directions: (" + std::string(length) + ",0,0) (0,1,0) (0,0,1)"),
            {"a.nrrd"});
}

}  // namespace
}  // namespace bonemill
