// From a folder of several acquisitions to the one that is milled, as a teacher calls the program.
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"

namespace bonemill {
namespace {

class ListSeriesCommand : public testing::Test {
  protected:
    // A block of bone in air, 24 x 24 x 12 voxels, whose value tells the acquisition.
    ListSeriesCommand() {
        std::filesystem::create_directory(folder_ / "scan");
        for (const int number : {1, 2})
            for (int k = 0; k < 12; ++k) {
                DicomImage image;
                image.acquisition_number = std::to_string(number);
                image.sop_uid = "1.2.3.4." + std::to_string(100 * number + k);
                image.position = "0\\0\\" + std::to_string(0.5 * k);
                image.rows = image.columns = 24;
                for (int n = 0; n < 24 * 24; ++n) {
                    const int i = n % 24, j = n / 24;
                    const bool is_bone = i >= 8 && i < 16 && j >= 8 && j < 16 && k >= 3 && k < 9;
                    image.pixels.push_back(int16_t(is_bone ? 1000 * number : -1000));
                }
                writeDicomFile(folder_ / ("scan/" + std::to_string(number) + "_" + std::to_string(k)), image);
            }
    }
    std::string scan() const { return folder_ / "scan"; }

    test::TemporaryFolder folder_;
};

TEST_F(ListSeriesCommand, PrintsATableAndARecommendation) {
    const test::Finished listed = test::run({"bonemill_lab", "list-series", scan()});
    EXPECT_EQ(listed.exit_code, 0) << listed.err;
    for (const char* words : {"acquisition", "24x24", "0.5 x 0.5 x 0.5",
                              "recommended for bone: series 1.2.3.4, acquisition 1: CT, slices 0.5 mm apart"})
        EXPECT_NE(listed.out.find(words), std::string::npos) << words << " in " << listed.out;
}

TEST_F(ListSeriesCommand, RefusesWhatHoldsNone) {
    std::filesystem::create_directory(folder_ / "empty");
    for (const std::string& path : {folder_ / "empty", folder_ / "nowhere"}) {
        const test::Finished refused = test::run({"bonemill_lab", "list-series", path});
        EXPECT_EQ(refused.exit_code, 2);
        EXPECT_NE(refused.err.find(path), std::string::npos) << refused.err;
    }
}

TEST_F(ListSeriesCommand, HapticServerBecomesBonemillLab) {
    const std::string line = "haptic_server: list-series is a command of bonemill_lab, which does it now\n";
    for (const std::vector<std::string>& words : {std::vector<std::string>{"list-series", scan()},
                                                  {"--log-level", "warn", "list-series", scan()},
                                                  {"list-series", folder_ / "nowhere"},
                                                  {"list-series", "--help"},
                                                  {"list-series"}}) {
        std::vector<std::string> call = words;
        call.insert(call.begin(), "bonemill_lab");
        const test::Finished lab = test::run(call);
        call[0] = "haptic_server";
        const test::Finished server = test::run(call);
        EXPECT_EQ(server.exit_code, lab.exit_code) << words.back();
        EXPECT_EQ(server.out, lab.out) << words.back();
        EXPECT_EQ(server.err, line + lab.err) << words.back();
    }
}

TEST_F(ListSeriesCommand, AnAcquisitionBecomesACase) {
    const test::Finished made =
        test::run({"bonemill_lab", "make-case", scan(), "--acquisition", "2", "--out", folder_ / "case"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.out.find("series 1.2.3.4, acquisition 2"), std::string::npos) << made.out;
    const test::Finished refused =
        test::run({"bonemill_lab", "make-case", scan(), "--acquisition", "3", "--out", folder_ / "other"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("holds no acquisition 3"), std::string::npos) << refused.err;
}

TEST_F(ListSeriesCommand, ASceneTakesTheAcquisitionThatItNames) {
    for (const char* number : {"1", "2"}) {
        test::writeFile(folder_ / "scene.textproto",
                        "volume { path: 'scan' series_uid: '1.2.3.4' acquisition: '" + std::string(number) +
                            "' iso_value: 300 }\n");
        const test::Finished described =
            test::run({"haptic_server", "--describe-scene", "--scene", folder_ / "scene.textproto"});
        ASSERT_EQ(described.exit_code, 0) << described.err;
        EXPECT_NE(described.out.find("told apart by acquisition number"), std::string::npos) << described.out;
        EXPECT_NE(described.out.find("taken: " + std::string(number)), std::string::npos) << described.out;
    }
}

}  // namespace
}  // namespace bonemill
