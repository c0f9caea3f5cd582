// Label maps as 3D Slicer writes them: names, colours, layers.
#include <gtest/gtest.h>

#include <stdexcept>

#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/labels/labels.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/seg_nrrd.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using Labels = std::vector<uint32_t>;

class SegNrrd : public testing::Test {
  protected:
    RawVolume imported(const SegmentsFile& file) const {
        writeSegNrrd(folder_ / "a.seg.nrrd", file);
        return importVolume(folder_ / "a.seg.nrrd");
    }
    void expectRefusal(const SegmentsFile& file, std::initializer_list<std::string> words) const {
        expectUserError([&] { imported(file); }, words);
    }
    static int ofColumn(const Eigen::Vector3i& v, int) { return v.x(); }

    test::TemporaryFolder folder_;
};

TEST_F(SegNrrd, hasTheNamesAndColoursOfItsLabels) {
    const RawVolume raw = imported({.segments = segmentLines(0, "facial nerve", 3, 0, "0.25 0.5 1") +
                                                segmentLines(1, "sinus", 1, 0, "none"),
                                    .label = ofColumn});
    ASSERT_EQ(raw.segments.list.size(), 2u);
    EXPECT_FALSE(raw.segments.are_layered);
    EXPECT_EQ(raw.segments.list[0].name, "facial nerve");
    EXPECT_EQ(raw.segments.list[0].labels, Labels{3});
    EXPECT_EQ(raw.segments.list[0].color, Eigen::Vector3d(0.25, 0.5, 1));
    EXPECT_EQ(raw.segments.list[1].labels, Labels{1});
    EXPECT_FALSE(raw.segments.list[1].color);
    EXPECT_EQ(raw.values[3], 3) << "labels stay what they are";
    EXPECT_EQ(labelsOfSegment(raw.segments, "sinus", "f"), Labels{1});
    expectUserError([&] { labelsOfSegment(raw.segments, "dura", "f"); },
                    {"f: has no segment \"dura\"", "facial nerve, sinus"});
    expectUserError([] { labelsOfSegment({}, "dura", "f"); }, {"f: names no segments", ".seg.nrrd"});
}

// The library counts layers with 32 bit: it would take these for one, and ask for memory for all of them.
TEST_F(SegNrrd, absurdSizesAreRefused) {
    imported({.layers = 2, .segments = segmentLines(0, "a", 1, 0), .label = ofColumn});
    std::string bytes = readBytes(folder_ / "a.seg.nrrd");
    const size_t sizes = bytes.find("sizes: 2 ");
    ASSERT_NE(sizes, std::string::npos);
    writeBytes(folder_ / "a.seg.nrrd", bytes.replace(sizes, 9, "sizes: 4294967297 "));
    expectUserError([&] { importVolume(folder_ / "a.seg.nrrd"); }, {"a.seg.nrrd", "absurd"});
}

// In the first layer a is 1 and b 2, in the second c is 1; c overlaps both.
TEST_F(SegNrrd, layersThatOverlapBecomeOne) {
    const auto label = [](const Eigen::Vector3i& v, int layer) {
        return layer == 1 ? int(v.y() == 1) : v.x() == 0 ? 1 : v.x() == 2 ? 2 : 0;
    };
    const RawVolume raw = imported({.layers = 2,
                                    .segments = segmentLines(0, "a", 1, 0) + segmentLines(1, "b", 2, 0) +
                                                segmentLines(2, "c", 1, 1) + segmentLines(3, "empty", 7, 1),
                                    .label = label});
    EXPECT_EQ(raw.geometry.dims, Eigen::Vector3i(4, 3, 2));
    EXPECT_TRUE(raw.geometry.spacing.isConstant(1e-3));
    EXPECT_TRUE(raw.segments.are_layered);
    const auto isOf = [&](const Eigen::Vector3i& v, const std::string& name) {
        const Labels labels = labelsOfSegment(raw.segments, name, "f");
        const auto value = uint32_t(raw.values[size_t(v.x() + 4 * (v.y() + 3 * v.z()))]);
        return std::ranges::find(labels, value) != labels.end();
    };
    forEachIndex({{0, 0, 0}, {3, 2, 1}}, [&](const Eigen::Vector3i& v) {
        EXPECT_EQ(isOf(v, "a"), v.x() == 0) << v.transpose();
        EXPECT_EQ(isOf(v, "b"), v.x() == 2) << v.transpose();
        EXPECT_EQ(isOf(v, "c"), v.y() == 1) << v.transpose();
        EXPECT_FALSE(isOf(v, "empty"));
    });
}

TEST_F(SegNrrd, ofOldVersionsHasALayerForEachSegment) {
    const auto label = [](const Eigen::Vector3i& v, int layer) { return int(v.x() >= layer); };
    const RawVolume raw =
        imported({.layers = 2, .segments = "Segment0_Name:=all\nSegment1_Name:=most\n", .label = label});
    EXPECT_EQ(labelsOfSegment(raw.segments, "all", "f").size(), 2u) << "alone, and with the other";
    EXPECT_EQ(labelsOfSegment(raw.segments, "most", "f").size(), 1u);
}

TEST_F(SegNrrd, thatCannotBeRightIsRefused) {
    const auto with = [](const std::string& lines, int layers = 1) {
        return SegmentsFile{.layers = layers, .segments = lines, .label = ofColumn};
    };
    expectRefusal(with(segmentLines(0, "a", 1, 1)), {"a.seg.nrrd", "segment a", "layer 1"});
    expectRefusal(with(segmentLines(0, std::string(65, 'a'), 1, 0)), {"segment 0", "64 bytes"});
    expectRefusal(with(segmentLines(0, "a\tb", 1, 0)), {"segment 0", "control characters"});
    expectRefusal(with(segmentLines(0, "", 1, 0)), {"segment 0", "name"});
    expectRefusal(with(segmentLines(256, "a", 1, 0)), {"more than 256 segments"});
    expectRefusal(with(segmentLines(0, "a", 70000, 0)), {"Segment0_LabelValue", "65535"});
    expectRefusal(with(segmentLines(0, "a", -1, 0)), {"Segment0_LabelValue"});
    expectRefusal(with("", 2), {"2 values per voxel"});
}

TEST(SegmentText, comesBack) {
    Segments segments;
    segments.are_layered = true;
    segments.list = {{"facial nerve", Eigen::Vector3d(0.5, 1, 0), {1, 4}}, {"empty", {}, {}}};
    const Segments back = segmentsFromText(textOfSegments(segments));
    ASSERT_EQ(back.list.size(), 2u);
    EXPECT_TRUE(back.are_layered);
    EXPECT_EQ(back.list[0].name, "facial nerve");
    EXPECT_EQ(back.list[0].color, segments.list[0].color);
    EXPECT_EQ(back.list[0].labels, (Labels{1, 4}));
    EXPECT_TRUE(back.list[1].labels.empty());
    EXPECT_TRUE(segmentsFromText(textOfSegments({})).list.empty());
}

TEST(SegmentText, thatAReaderWasMadeToWriteIsRefused) {
    std::string many = "single\n";
    for (int n = 0; n < 257; ++n) many += "a\n-\n1\n";
    for (const std::string& text :
         {std::string("odd\n"), std::string("single\na\n"), std::string("single\n\n-\n1\n"),
          std::string("single\na\x1b\n-\n1\n"), std::string("single\na\n-\n70000\n"),
          std::string("single\na\n-\n-1\n"), std::string("single\na\n-\n2 2\n"),
          std::string("single\na\n-\n2 x\n"), std::string("single\na\n1 2 nan\n2\n"),
          "single\n" + std::string(65, 'a') + "\n-\n1\n", many})
        EXPECT_THROW(segmentsFromText(text), std::length_error) << text.substr(0, 40);
}

}  // namespace
}  // namespace bonemill
