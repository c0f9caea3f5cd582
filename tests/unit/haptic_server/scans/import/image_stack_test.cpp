// Folders of pictures, written byte by byte, as volumes.
#include <gtest/gtest.h>

#include <fstream>

#include "haptic_server/scans/formats/slice_names.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/picture_files.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

ImportOptions withSpacing(const Eigen::Vector3d& mm) {
    ImportOptions options;
    options.spacing_mm = mm;
    return options;
}

const ImportOptions kSpacing = withSpacing({0.5, 0.75, 1.25});

class ImageStack : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& bytes) const { writeBytes(folder_ / name, bytes); }
    // They are called a8 to a10, so that letters would put the last one first.
    void writeStack(const std::string& ending, const std::function<std::string(const Picture&)>& bytes,
                    Picture picture) const {
        for (picture.slice = 0; picture.slice < 3; ++picture.slice)
            write("a" + std::to_string(picture.slice + 8) + ending, bytes(picture));
    }
    void expectStack(const Picture& like) const {
        const RawVolume raw = importVolume(folder_.path(), kSpacing);
        EXPECT_EQ(raw.geometry.dims, Eigen::Vector3i(like.width, like.height, 3));
        EXPECT_TRUE(raw.geometry.spacing.isApprox(Eigen::Vector3d(0.5e-3, 0.75e-3, 1.25e-3)));
        EXPECT_TRUE(raw.lacks_patient_axes);
        size_t n = 0;
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < like.height; ++j)
                for (int i = 0; i < like.width; ++i) {
                    Picture picture = like;
                    picture.slice = k;
                    ASSERT_EQ(raw.values[n++], picture.value(i, j)) << i << " " << j << " " << k;
                }
    }
    void expectRefusal(std::initializer_list<std::string> words,
                       const ImportOptions& options = kSpacing) const {
        expectUserError([&] { importVolume(folder_.path(), options); }, words);
    }

    test::TemporaryFolder folder_;
};

TEST_F(ImageStack, ofPngIsReadInTheOrderOfItsNumbers) {
    for (const int bits : {8, 16}) {
        writeStack(".png", png, pictureOf(bits));
        expectStack(pictureOf(bits));
    }
}

TEST_F(ImageStack, ofTiffIsReadInTheOrderOfItsNumbers) {
    for (const int bits : {8, 16}) {
        writeStack(".tif", tiff, pictureOf(bits));
        expectStack(pictureOf(bits));
    }
}

TEST_F(ImageStack, mayLieBesideAFewOtherFiles) {
    writeStack(".png", png, {});
    write("scan.log", "Voltage=80");
    write(".DS_Store", "x");
    expectStack({});
    EXPECT_NE(importVolume(folder_.path(), kSpacing).description.find("1 other files left out"),
              std::string::npos);
}

TEST_F(ImageStack, needsTheSizeOfItsVoxels) {
    writeStack(".png", png, {});
    expectRefusal({folder_.path().string(), "write volume.spacing_mm"}, {});
    expectRefusal({"volume.spacing_mm", "above 0"}, withSpacing({1, 1, 0}));
}

TEST_F(ImageStack, ofPicturesThatDifferIsRefused) {
    Picture wide, coloured;
    wide.width = 6;
    coloured.channels = 3;
    writeStack(".png", png, {});
    write("a11.png", png(wide));
    expectRefusal({"a11.png", "6 x 4", "a8.png", "5 x 4"});
    write("a11.png", png(pictureOf(8)));
    expectRefusal({"a11.png", "8 bit", "16 bit"});
    write("a11.png", png(coloured));
    expectRefusal({"a11.png", "colour"});
    write("a11.png", png({}).substr(0, 60));
    expectRefusal({"a11.png"});
    std::filesystem::remove(folder_ / "a11.png");
    write("a11.tif", tiff({}));
    expectRefusal({"a11.tif", "another type"});
}

TEST_F(ImageStack, ofWhichNumbersAreMissingIsRefused) {
    for (const int n : {0, 1, 2, 3, 4, 8, 9, 11}) write("slice000" + std::to_string(n) + ".png", png({}));
    expectRefusal({folder_.path().string(), "number 5 to 7, 10", "slice0004 is followed by slice0008"});
}

TEST_F(ImageStack, ofEvenStepsIsSaidToBe) {
    for (const char* n : {"02", "04", "06", "08"}) write(std::string("s") + n + ".tif", tiff({}));
    EXPECT_NE(importVolume(folder_.path(), kSpacing).description.find("numbered in steps of 2"),
              std::string::npos);
}

TEST_F(ImageStack, ofOtherPicturesSaysSo) {
    for (const char* name : {"a1.jpg", "a2.jpg", "a3.JPEG", "a4.bmp"}) write(name, "x");
    expectRefusal({"a1.jpg", "PNG or TIFF"}, {});
}

TEST(SliceNames, AreThoseOfOneWholeStack) {
    const auto problem = [](const std::vector<std::string>& names) { return sliceNumbersOf(names).problem; };
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"a", "b", "d"},
          {"a1"},
          {"a7", "a8", "a9"},
          {"a08", "a09", "a10"},
          {"ct_2024_1", "ct_2024_2", "ct_2024_3"},
          {"t1030_s1", "t1031_s2", "t1035_s3"},
          {"p1_s1", "p1_s2", "p2_s3", "p2_s4"},
          {"1.2.840.99999999999999999999_1", "1.2.840.99999999999999999999_2"},
          {"z0010_1", "z0025_2", "z0040_3"},
          {"s1_z0.5", "s2_z1.0", "s3_z1.5"}})
        EXPECT_EQ(problem(names), "") << names.back();
    const std::pair<std::vector<std::string>, const char*> wrong[] = {
        {{"a1", "a2", "a4"}, "number 3 (a2 is followed by a4)"},
        {{"a1", "a3", "a5", "a9"}, "number 7 (a5 is followed by a9)"},
        {{"a1", "a2", "a3", "a103"}, "number 4 to 102"},
        {{"a1", "a3", "a4", "a8", "a9", "a12", "a13", "a15", "a16", "a18"},
         "number 2, 5 to 7, 10 to 11, 14, ..."},
        {{"a1", "a2", "b1", "b2"}, "a1 to a2 (2), b1 to b2 (2)"},
        {{"a1", "a2", "a3", "overview"}, "overview"},
        {{"a01", "a1", "a2"}, "a01 and a1 have the same number"},
        {{"p1_s1", "p1_s2", "p2_s1", "p2_s2"}, "counts them all (p1_s1 and p1_s2, ..., p2_s2)"},
        {{"z-1", "z0", "z1"}, "several kinds"},
        {{"a0", "a2", "a4", "a7", "a9"}, "do not run evenly (a4, a7)"},
    };
    for (const auto& [names, words] : wrong)
        EXPECT_NE(problem(names).find(words), std::string::npos) << problem(names) << ", not " << words;
}

TEST_F(ImageStack, sizeOfVoxelsServesFilesThatDoNotSayIt) {
    SampleVolume sample;
    writeNrrdFile(folder_ / "a.nrrd", sample, {});
    expectUserError([&] { importVolume(folder_ / "a.nrrd", kSpacing); },
                    {"a.nrrd", "leave volume.spacing_mm out"});
    const std::string bytes = readBytes(folder_ / "a.nrrd");
    write("b.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n\n" +
                        bytes.substr(bytes.find("\n\n") + 2));
    expectUserError([&] { importVolume(folder_ / "b.nrrd"); }, {"b.nrrd", "write volume.spacing_mm"});
    sample.origin_mm.setZero();
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder_ / "b.nrrd", kSpacing), sample));
    writeMetaImageFile(folder_ / "a.mha", sample, {});
    std::string meta = readBytes(folder_ / "a.mha");
    const size_t at = meta.find("ElementSpacing");
    write("b.mha", meta.erase(at, meta.find('\n', at) + 1 - at));
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder_ / "b.mha", kSpacing), sample));
    writeNiftiFile(folder_ / "a.nii", sample, {});
    expectUserError([&] { importVolume(folder_ / "a.nii", kSpacing); },
                    {"a.nii", "leave volume.spacing_mm out"});
}

TEST(NaturalOrder, takesNumbersAsNumbers) {
    EXPECT_TRUE(isBeforeNaturally("a2", "a10"));
    EXPECT_FALSE(isBeforeNaturally("a10", "a2"));
    EXPECT_TRUE(isBeforeNaturally("a2_b10", "a02_b11"));
    EXPECT_TRUE(isBeforeNaturally("a", "a1"));
    EXPECT_TRUE(isBeforeNaturally("a01", "a1") != isBeforeNaturally("a1", "a01"));
    EXPECT_FALSE(isBeforeNaturally("a1", "a1"));
    EXPECT_TRUE(isBeforeNaturally("a99999999999999999999998", "a99999999999999999999999"));
}

}  // namespace
}  // namespace bonemill
