// What a folder holds is told in full, and nothing of its files but text comes through.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "haptic_server/scans/confined/guarded_import.h"
#include "haptic_server/scans/dicom/series_table.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

class ListSeries : public testing::Test {
  protected:
    // Of slices that are all a bit brighter than those of the stack before.
    template <class Change>
    void writeStack(const std::string& uid, int count, double step_mm, Change change) {
        ++stacks_;
        for (int k = 0; k < count; ++k) {
            DicomImage image;
            image.series_uid = uid;
            image.sop_uid = uid + "." + std::to_string(1000 * stacks_ + k);
            image.position = "0\\0\\" + std::to_string(k * step_mm);
            image.pixels.assign(20, int16_t(100 * stacks_ + k));
            change(image);
            writeDicomFile(folder_ / (std::to_string(stacks_) + "_" + std::to_string(k)), image);
        }
    }
    // The lines that hold all these words, in this order.
    std::string line(std::initializer_list<std::string> words) {
        for (const std::string& text : lines_) {
            size_t at = 0;
            for (const std::string& word : words)
                if (at != std::string::npos) at = text.find(word, at);
            if (at != std::string::npos) return text;
        }
        return "";
    }
    void list() { lines_ = listSeries(folder_.path()); }
    // Cuts `bytes` off the end of this slice's file.
    void cut(const std::string& name, size_t bytes) const {
        const std::string all = readBytes(folder_ / name);
        writeBytes(folder_ / name, all.substr(0, all.size() - bytes));
    }
    // What is recommended is what is read, whether it is asked for or not; where nothing is, nothing is read.
    // Returns its description, or what is wrong.
    std::string expectTaken(const std::string& uid, const std::string& acquisition = "-") {
        list();
        SCOPED_TRACE(text());
        const auto rows = rowsOfTable(lines_);
        const auto row = std::ranges::find(rows, true, &SeriesRow::is_recommended);
        if (uid.empty()) {
            EXPECT_EQ(row, rows.end());
            EXPECT_FALSE(line({"recommended for bone: none"}).empty());
            try {
                return "read: " + importVolume(folder_.path()).description;
            } catch (const UserError& error) {
                return error.what();
            }
        }
        if (row == rows.end() || row->uid != uid || row->acquisition != acquisition) {
            ADD_FAILURE() << uid << " is not recommended";
            return {};
        }
        ImportOptions options{.series_uid = row->uid};
        if (acquisition != "-") options.acquisition = acquisition;
        const RawVolume asked = importVolume(folder_.path(), options), unasked = importVolume(folder_.path());
        EXPECT_TRUE(asked.values == unasked.values) << unasked.description;
        EXPECT_EQ(std::to_string(unasked.geometry.dims.z()), row->slices);
        return unasked.description;
    }
    std::string text() const {
        std::string all;
        for (const std::string& text : lines_) all += text + "\n";
        return all;
    }

    test::TemporaryFolder folder_;
    int stacks_ = 0;
    std::vector<std::string> lines_;
};

TEST_F(ListSeries, IsReadAgainRowByRow) {
    for (const char* number : {"1", "2"})
        writeStack("1.2.1", 6, 0.6, [&](DicomImage& image) {
            image.acquisition_number = number;
            image.kernel = "H60s";
            image.series_description = "Head, sharp";
        });
    writeStack("1.2.2", 5, 0.6, [](DicomImage&) {});
    list();
    const std::vector<SeriesRow> rows = rowsOfTable(lines_);
    ASSERT_EQ(rows.size(), 3u) << text();
    EXPECT_EQ(rows[1].uid, "1.2.1");
    EXPECT_EQ(rows[1].acquisition, "2");
    EXPECT_EQ(rows[1].description, "Head, sharp");
    EXPECT_EQ(rows[1].kernel, "H60s");
    EXPECT_EQ(rows[1].contrast, "-");
    EXPECT_EQ(rows[1].slices, "6");
    EXPECT_EQ(rows[1].voxel_mm, "0.5 x 0.5 x 0.6");
    EXPECT_EQ(rows[2].acquisition, "-");
    EXPECT_TRUE(rows[0].is_recommended) << text();
    EXPECT_FALSE(rows[1].is_recommended) << "another acquisition of the same series";
    EXPECT_FALSE(rows[2].is_recommended);
    EXPECT_TRUE(rowsOfTable({"something else"}).empty());
    EXPECT_TRUE(rowsOfTable({}).empty());
}

TEST_F(ListSeries, TellsStacksAndRecommendsOne) {
    for (const char* number : {"1", "2"})
        writeStack("1.2.1", 6, 0.6, [&](DicomImage& image) {
            image.acquisition_number = number;
            image.kernel = "B30f";
            image.series_description = "Head soft";
            image.contrast = "iodine";
        });
    writeStack("1.2.2", 5, 0.6, [](DicomImage& image) { image.kernel = "H60s"; });
    writeStack("1.2.3", 9, 0.3, [](DicomImage& image) { image.modality = "MR"; });
    list();
    EXPECT_FALSE(line({"series", "acquisition", "modality", "description", "kernel", "contrast", "slices",
                       "size", "voxel mm", "remark"})
                     .empty())
        << text();
    for (const char* number : {"1", "2"})
        EXPECT_FALSE(line({"1.2.1", number, "CT", "Head soft", "B30f", "iodine", "6", "5x4",
                           "0.5 x 0.5 x 0.6", "told from stacks that overlap it by acquisition number"})
                         .empty())
            << text();
    EXPECT_FALSE(line({"1.2.3", "-", "MR", "0.5 x 0.5 x 0.3", "-"}).empty()) << text();
    EXPECT_EQ(line({"recommended"}),
              "recommended for bone: series 1.2.2: CT, bone kernel H60s, slices 0.6 mm apart, 5 slices");
    EXPECT_FALSE(line({"series_uid: \"1.2.2\"", "--series 1.2.2"}).empty()) << text();
}

TEST_F(ListSeries, SaysWhatIsWrong) {
    writeStack("1.2.1", 12, 1, [](DicomImage&) {});
    for (const int k : {4, 5, 6, 7}) std::filesystem::remove(folder_ / ("1_" + std::to_string(k)));
    writeStack("1.2.2", 6, 1, [k = 0](DicomImage& image) mutable {
        image.position = "0\\" + std::to_string(0.2 * k) + "\\" + std::to_string(k);
        ++k;
    });
    writeBytes(folder_ / "damaged", readBytes(folder_ / "1_0").substr(0, 400));
    writeBytes(folder_ / "readme", "text");
    list();
    EXPECT_FALSE(line({"1.2.1", "cannot be used: 4 slices are missing"}).empty()) << text();
    EXPECT_FALSE(line({"1.2.2", "gantry tilt of 11.31 degrees"}).empty()) << text();
    EXPECT_FALSE(line({"recommended for bone: series 1.2.2"}).empty()) << text();
    EXPECT_FALSE(line({"cannot be read: ", "damaged", "cut short"}).empty()) << text();
    EXPECT_FALSE(line({"files left out: 1 files that are not DICOM (readme)"}).empty()) << text();
}

TEST_F(ListSeries, AllLinesArePrintable) {
    writeStack("1.2.1", 4, 1, [](DicomImage& image) {
        image.series_description = "a\n\x1b[2Jb\x9b\xff" + std::string(3000, 'x');
        image.acquisition_number = "1\n2";
    });
    list();
    for (const std::string& text : lines_) {
        EXPECT_LT(text.size(), 1300u);
        for (const unsigned char c : text) EXPECT_TRUE(c >= ' ' && c <= '~') << int(c);
    }
    EXPECT_FALSE(line({"1.2.1", "a??[2Jb??xxx"}).empty()) << text();
}

TEST_F(ListSeries, EveryNameInTheTableChooses) {
    for (const char* type : {"ORIGINAL\\PRIMARY", "DERIVED\\SECONDARY"})
        writeStack("1.2.1", 6, 1, [&](DicomImage& image) { image.image_type = type; });
    list();
    EXPECT_FALSE(line({"type DERIVED/SECONDARY"}).empty()) << text();
    EXPECT_EQ(importVolume(folder_.path(), {.acquisition = "type DERIVED/SECONDARY"}).values[0], 200);
    const RawVolume raw = importVolume(folder_.path());
    EXPECT_EQ(raw.values[0], 100) << "the original";
    EXPECT_NE(raw.description.find("2 stacks that overlap, told apart by image type"), std::string::npos)
        << raw.description;
}

TEST_F(ListSeries, DiffusionWeightingsAreReadAsNumbers) {
    for (const double b : {0.0, 1000.0})
        writeStack("1.2.1", 6, 1, [&](DicomImage& image) { image.b_value = {b}; });
    EXPECT_EQ(importVolume(folder_.path(), {.acquisition = "b 1000"}).values[0], 200);
}

TEST_F(ListSeries, PhasesOfFramesAreToldApart) {
    DicomImage image;
    for (int k = 0; k < 3; ++k)
        for (const int phase : {1, 2}) {
            image.frame_positions.push_back("0\\0\\" + std::to_string(k));
            image.frame_phases.push_back(phase);
            image.pixels.insert(image.pixels.end(), 20, int16_t(100 * phase + k));
        }
    writeDicomFile(folder_ / "a.dcm", image);
    for (const int phase : {1, 2}) {
        const RawVolume raw =
            importVolume(folder_ / "a.dcm", {.acquisition = "phase " + std::to_string(phase)});
        ASSERT_EQ(raw.geometry.dims.z(), 3);
        for (size_t n = 0; n < raw.values.size(); ++n) EXPECT_EQ(raw.values[n], 100 * phase + int(n / 20));
    }
    EXPECT_EQ(listSeries(folder_ / "a.dcm"), listSeries(folder_.path()));
}

void expectWords(const std::string& text, std::initializer_list<std::string> words) {
    for (const std::string& word : words)
        EXPECT_NE(text.find(word), std::string::npos) << "no \"" << word << "\" in: " << text;
}

TEST_F(ListSeries, ADamagedFileOfAnotherSeriesIsLeftOutWithAWord) {
    writeStack("1.2.1", 6, 1, [](DicomImage&) {});
    writeStack("1.2.2", 9, 1, [](DicomImage&) {});
    cut("2_8", 20);
    const std::string read = expectTaken("1.2.1");
    expectWords(read, {"damaged files of other series left out", "2_8: the DICOM file is cut short", "1.2.2",
                       "which cannot be used: a file of this series cannot be read"});
    expectUserError([&] { importVolume(folder_.path(), {.series_uid = "1.2.2"}); },
                    {"a file of this series cannot be read", "2_8", "cut short", "copy it anew"});
    writeStack("1.2.2", 1, 1, [](DicomImage& image) { image.pixel_spacing = "0\\0"; });
    std::filesystem::remove(folder_ / "2_8");
    expectWords(expectTaken("1.2.1"), {"3_0", "Pixel Spacing"});
}

TEST_F(ListSeries, ASeriesThatLacksPixelsIsNotRecommended) {
    writeStack("1.2.1", 6, 1, [](DicomImage&) {});
    writeStack("1.2.2", 9, 1,
               [](DicomImage& image) { image.pixels.resize(image.sop_uid.ends_with("3") ? 10 : 20); });
    expectWords(expectTaken("1.2.1"), {"2_3: Pixel Data has 20 bytes", "need 40"});
}

TEST_F(ListSeries, ADamagedFileOfTheSeriesIsNotLeftOut) {
    writeStack("1.2.1", 6, 1, [](DicomImage&) {});
    writeBytes(folder_ / "1_6", readBytes(folder_ / "1_5"));
    cut("1_6", 20);
    expectWords(expectTaken(""), {"a file of this series cannot be read", "1_6"});
}

TEST_F(ListSeries, ADamagedFileOfWhoKnowsWhichSeriesIsOfAny) {
    writeStack("1.2.1", 6, 1, [](DicomImage&) {});
    writeStack("1.2.2", 6, 1, [](DicomImage&) {});
    writeBytes(folder_ / "2_5", readBytes(folder_ / "2_5").substr(0, 260));
    expectWords(expectTaken(""), {"a file that may be of this series cannot be read", "2_5", "elsewhere"});
}

TEST_F(ListSeries, WhatIsNoPictureIsLeftOutWithAWord) {
    writeStack("1.2.1", 6, 1, [](DicomImage&) {});
    writeStack("1.2.2", 1, 1, [](DicomImage& image) { image.has_pixels = false; });
    writeStack("1.2.3", 7, 1, [](DicomImage& image) { image.position.clear(); });
    writeStack("1.2.4", 3, 1, [](DicomImage& image) { image.modality = "CT"; });
    writeBytes(folder_ / "note.txt", "text");
    writeBytes(folder_ / "empty.dcm", "");
    expectWords(expectTaken("1.2.1"), {"1 DICOM files without an image (2_0)", "2 files that are not DICOM",
                                       "7 images without a position", "3 slices 5x4 of CT series 1.2.4"});
}

TEST_F(ListSeries, WhatIsTakenUnaskedIsWhatIsRecommended) {
    writeStack("1.2.1", 12, 0.7, [](DicomImage& image) { image.kernel = "B30f"; });
    writeStack("1.2.2", 8, 1, [](DicomImage& image) { image.kernel = "B70f"; });
    expectWords(expectTaken("1.2.2"), {"12 slices 5x4 of CT series 1.2.1"});
    writeStack("1.2.0", 30, 0.5, [](DicomImage& image) { image.modality = "MR"; });
    expectTaken("1.2.2");
    for (const char* number : {"7", "5"})  // the same places
        writeStack("1.2.3", 9, 0.8, [&](DicomImage& image) {
            image.acquisition_number = number;
            image.kernel = "H60s";
        });
    expectTaken("1.2.3", "5");
    for (const int k : {3, 4, 5, 6}) std::filesystem::remove(folder_ / ("5_" + std::to_string(k)));
    expectWords(expectTaken("1.2.3", "7"), {"told apart by acquisition number"});
}

TEST_F(ListSeries, WhatLiesBesideABrokenStackIsNoScan) {
    writeStack("1.2.1", 16, 1, [](DicomImage&) {});
    for (const int k : {5, 6, 7, 8, 9}) std::filesystem::remove(folder_ / ("1_" + std::to_string(k)));
    writeStack("1.2.1", 5, 1, [k = 5](DicomImage& image) mutable {
        image.position = "0\\0\\" + std::to_string(k++);
        image.columns = 4;
        image.pixels.resize(16);
    });
    expectWords(expectTaken(""), {"has 4x4 pixels, the others 5x4"});
    writeStack("1.2.2", 4, 3, [](DicomImage&) {});
    expectWords(expectTaken("1.2.2"), {"which cannot be used: between"});
}

TEST_F(ListSeries, ScoutsAreTakenOnlyWhereThereIsNothingElse) {
    writeStack("1.2.1", 3, 1, [](DicomImage&) {});
    expectWords(expectTaken(""), {"read: DICOM series 1.2.1"});
    writeStack("1.2.2", 4, 1, [](DicomImage&) {});
    expectTaken("1.2.2");
}

TEST_F(ListSeries, WhatHoldsNoSeriesIsRefused) {
    expectUserError([&] { list(); }, {"empty"});
    writeBytes(folder_ / "readme", "text");
    expectUserError([&] { list(); }, {"no DICOM slice that can be used"});
    expectUserError([&] { listSeries(folder_ / "readme"); }, {"readme", "no DICOM file"});
    expectUserError([&] { listSeries(folder_ / "nothing"); }, {"no such file"});
}

// What a reader says that was taken over.
TEST_F(ListSeries, OnlyTextComesThroughAndNotTooMuch) {
    const auto lie = []() -> Lines { return {"one\x1b[2J\r\ttwo\x9b", "three\nfour"}; };
    EXPECT_EQ(linesGuarded("f", lie), (Lines{"one?[2J??two?", "three", "four"}));
    const auto flood = []() -> Lines { return {std::string(2 << 20, 'a')}; };
    expectUserError([&] { linesGuarded("f", flood); }, {"f", "fit together"});
    const auto wrong_kind = [](int pipe, int) {
        const pid_t child = fork();
        if (child == 0) readLinesAsChild(pipe, "f", []() -> Lines { return {"text"}; });
        return child;
    };
    expectUserError([&] { importFrom("f", wrong_kind); }, {"f", "fit together"});
}

}  // namespace
}  // namespace bonemill
