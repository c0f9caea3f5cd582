// Files that share a series but are not one scan, and scales that are half said or said elsewhere: the values
// and places that are stored, or a refusal that names what is at fault.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/deflated_bytes.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/dicom_elements.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/recoded_dicom.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using dicom::element, dicom::item;

constexpr int kStackSlices = 8, kSlicePixels = 20;

float stackValue(int slice, int pixel) {
    return float(pixel + 100 * slice);
}

std::string doubleElement(uint32_t tag, double value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return element(tag, "FD", bytes);
}

std::string mappingItem(double slope, double intercept) {
    return item(doubleElement(0x00409224, intercept) + doubleElement(0x00409225, slope));
}

std::string mappings(const std::string& items) {
    return element(0x00409096, "SQ", items);
}

class DicomOneScan : public testing::Test {
  protected:
    using Change = std::function<void(DicomImage&, int)>;

    // A stack of slices, each changed, one file of each.
    void write(const Change& change) {
        std::filesystem::remove_all(folder_ / "scan");
        std::filesystem::create_directories(folder_ / "scan");
        for (int k = 0; k < kStackSlices; ++k) {
            DicomImage image = sliceAt(k);
            change(image, k);
            writeDicomFile(folder_ / ("scan/slice" + std::to_string(k)), image);
        }
    }
    // The same in one enhanced file.
    void writeFrames(const std::function<void(DicomImage&)>& change) {
        std::filesystem::remove_all(folder_ / "scan");
        std::filesystem::create_directories(folder_ / "scan");
        DicomImage image;
        for (int k = 0; k < kStackSlices; ++k) {
            image.frame_positions.push_back(positionOf(k));
            for (int n = 0; n < kSlicePixels; ++n) image.pixels.push_back(int16_t(stackValue(k, n)));
        }
        change(image);
        writeDicomFile(folder_ / "scan/frames", image);
    }
    RawVolume imported() { return importVolume(folder_ / "scan"); }
    void expectRefused(std::initializer_list<std::string> words) {
        expectUserError([&] { imported(); }, words);
    }
    void expectScaled(float slope, float intercept) {
        RawVolume raw;
        ASSERT_NO_THROW(raw = imported());
        ASSERT_EQ(raw.values.size(), size_t(kStackSlices * kSlicePixels));
        for (int k = 0; k < kStackSlices; ++k)
            for (int n = 0; n < kSlicePixels; ++n)
                ASSERT_NEAR(raw.values[size_t(k * kSlicePixels + n)], slope * stackValue(k, n) + intercept,
                            1e-3)
                    << "slice " << k << ", pixel " << n;
    }

    static std::string positionOf(int slice) { return "10\\-20\\" + std::to_string(slice); }
    static DicomImage sliceAt(int slice) {
        DicomImage image;
        image.position = positionOf(slice);
        image.sop_uid = "1.2.3.4." + std::to_string(slice + 1);
        image.intercept = -1024;
        for (int n = 0; n < kSlicePixels; ++n) image.pixels.push_back(int16_t(stackValue(slice, n)));
        return image;
    }

    test::TemporaryFolder folder_;
};

TEST_F(DicomOneScan, slicesOfWhichSomeDoNotSayTheirScaleAreRefused) {
    for (const bool is_odd : {false, true}) {
        write([&](DicomImage& image, int k) { image.has_rescale = k % 2 == int(is_odd); });
        expectRefused({is_odd ? "slice0" : "slice1", "Rescale Slope and Intercept", "4 of 8", "export"});
        EXPECT_NE(listSeries(folder_ / "scan")[1].find("cannot be used"), std::string::npos);
    }
    write([](DicomImage& image, int) { image.has_rescale = false; });
    expectScaled(1, 0);
}

TEST_F(DicomOneScan, aSlopeWithoutAnInterceptIsRefusedAndTheReverse) {
    write([](DicomImage& image, int) { image.last_elements = element(0x00281053, "DS", "2"); });
    expectRefused({"slice0", "Rescale Slope without a Rescale Intercept"});
    write([](DicomImage& image, int) { image.last_elements = element(0x00281052, "DS", "-1024"); });
    expectRefused({"slice0", "Rescale Intercept without a Rescale Slope"});
}

TEST_F(DicomOneScan, aRealWorldMappingScalesWhereNothingElseDoes) {
    const std::string line = mappings(mappingItem(2, -1024));
    write([&](DicomImage& image, int) { image.last_elements = line; });
    expectScaled(2, -1024);
    writeFrames([&](DicomImage& image) { image.shared_groups = line; });
    expectScaled(2, -1024);
    writeFrames([&](DicomImage& image) {
        image.shared_groups = line;
        image.shared_rescale = "3|-7";
    });
    expectScaled(3, -7);
}

TEST_F(DicomOneScan, aRealWorldMappingThatIsNoLineIsRefused) {
    const std::string table = item(element(0x00409212, "FD", std::string(64, '\0')));
    const std::string kNoLines[] = {mappings(table), mappings(mappingItem(0, 5)),
                                    mappings(mappingItem(1, 0) + mappingItem(2, 0))};
    for (const std::string& no_line : kNoLines) {
        write([&](DicomImage& image, int) { image.last_elements = no_line; });
        expectRefused({"slice0", "Real World Value Mapping", "export"});
    }
}

TEST_F(DicomOneScan, slicesOfSeveralSourcesAreSeveralStacks) {
    struct Source {
        const char* said;
        void (*change)(DicomImage&);
    };
    const Source kSources[] = {{"patient", [](DicomImage& image) { image.patient_id = "other"; }},
                               {"modality", [](DicomImage& image) { image.modality = "PT"; }},
                               {"Frame of Reference", [](DicomImage& image) { image.space_uid = "1.2.9"; }}};
    for (const Source& source : kSources) {
        SCOPED_TRACE(source.said);
        write([&](DicomImage& image, int k) {  // one stack above the other
            if (k >= 5) source.change(image);
        });
        const RawVolume raw = imported();
        EXPECT_EQ(raw.geometry.dims.z(), 5);
        EXPECT_NE(raw.description.find("left out: 3 slices"), std::string::npos) << raw.description;
        EXPECT_EQ(listSeries(folder_ / "scan")[3].find("recommended"), 0u);
        write([&](DicomImage& image, int k) {  // one between the other
            if (k % 2 == 1) source.change(image);
        });
        EXPECT_EQ(imported().geometry.dims.z(), 4);
        write([&](DicomImage& image, int k) {
            if (k >= 3 && k <= 5) source.change(image);
        });
        expectRefused({"between slice2", "slice6", source.said});
    }
    write([](DicomImage& image, int k) { image.space_uid = "1.2.9." + std::to_string(k); });
    expectRefused({"there is one", "another Frame of Reference", "7 slices"});
}

TEST_F(DicomOneScan, enhancedFilesOfOneFrameEachAreRead) {
    write([&](DicomImage& image, int k) {
        image.frame_positions = {positionOf(k)};
        image.pixel_spacing = "0.7\\0.4";
        image.shared_rescale = "2|-1000";
    });
    expectScaled(2, -1000);
    const RawVolume raw = imported();
    EXPECT_TRUE(raw.geometry.spacing.isApprox(Eigen::Vector3d(0.4e-3, 0.7e-3, 1e-3), 1e-9));
    EXPECT_TRUE(raw.geometry.X_WV.position.isApprox(Eigen::Vector3d(10e-3, -20e-3, 0), 1e-9));
}

TEST_F(DicomOneScan, aDeflatedEnhancedFileIsRead) {
    std::string bytes;
    writeFrames([&](DicomImage& image) {
        image.shared_rescale = "2|-1000";
        image.transfer_syntax = "1.2.840.10008.1.2.1.99";
        bytes = dicomBytes(image);
    });
    const size_t meta = 128 + 4 + 12 + dicom::numberAt(bytes, 128 + 4 + 8, 4);
    writeBytes(folder_ / "scan/frames",
               bytes.substr(0, meta) + deflated(bytes.substr(meta), DeflateHead::kNone));
    expectScaled(2, -1000);
}

TEST_F(DicomOneScan, framesThatAreMoreOrFewerThanDescribedAreRefused) {
    for (const char* count : {"1", "5"}) {
        writeFrames([&](DicomImage& image) { image.frame_count = count; });
        expectRefused({"frames", "describes 8 frames", std::string("Number of Frames is ") + count});
    }
}

}  // namespace
}  // namespace bonemill
