#include "haptic_server/teaching/attempt_report/result_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "common/base/user_error.h"
#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "tests/support/process.h"
#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

class ResultFolderTest : public testing::Test {
  protected:
    const test::TemporaryFolder folder_;
    const ResultFolder results_{folder_ / "."};
};

TEST_F(ResultFolderTest, AnAttemptLeavesItsFilesForItsUserAlone) {
    results_.write(test::typicalResult(), {}, 0);
    const std::string stem = "20261118T113640Z_P07_3";
    EXPECT_EQ(fileStemOf(test::typicalResult()), stem);
    for (const char* ending : {".json", ".html"}) {
        struct stat status {};
        ASSERT_EQ(stat((results_.results() / (stem + ending)).c_str(), &status), 0) << ending;
        EXPECT_EQ(status.st_mode & 0777, 0600) << ending;
    }
    results_.write(test::typicalResult("P08", 4), {}, 0);
    EXPECT_EQ(std::ranges::count(test::readFile(results_.statements()), '\n'), 2);
}

TEST_F(ResultFolderTest, ANameIsNoPath) {
    AttemptResult result = test::typicalResult("../../etc/pass wd");
    EXPECT_TRUE(fileStemOf(result).starts_with("20261118T113640Z_______etc_pass_wd-")) << fileStemOf(result);
    results_.write(result, {}, 0);
    EXPECT_EQ(ResultFolder::read(results_.results(), result.scene_hash, result.pseudonym).size(), 1);
}

TEST_F(ResultFolderTest, NoTwoPeopleHaveTheSameFile) {
    EXPECT_NE(fileStemOf(test::typicalResult("P\u00e4")), fileStemOf(test::typicalResult("P\u00f6")));
    EXPECT_NE(fileStemOf(test::typicalResult("P_1")), fileStemOf(test::typicalResult("P 1")));
}

TEST_F(ResultFolderTest, NothingIsWrittenThroughALink) {
    const test::TemporaryFolder elsewhere;
    const std::string stem = fileStemOf(test::typicalResult());
    test::writeFile(elsewhere / "file", "somebody's");
    std::filesystem::create_directories(results_.results());
    std::filesystem::create_symlink(elsewhere / "file", results_.results() / (stem + ".json"));
    EXPECT_THROW(results_.write(test::typicalResult(), {}, 0), UserError);
    EXPECT_EQ(test::readFile(elsewhere / "file"), "somebody's");
    std::filesystem::remove_all(results_.results());
    std::filesystem::create_directory_symlink(elsewhere.path(), results_.results());
    EXPECT_THROW(results_.write(test::typicalResult(), {}, 0), UserError);
    EXPECT_FALSE(std::filesystem::exists(elsewhere / (stem + ".json")));
}

TEST_F(ResultFolderTest, TheReportShowsThisPersonsAttemptsInThisScene) {
    for (uint32_t n = 1; n <= 3; ++n) results_.write(test::typicalResult("P07", n), {}, 0);
    AttemptResult other = test::typicalResult("P07", 4);
    other.scene_hash = "1";
    results_.write(other, {}, 0);
    results_.write(test::typicalResult("P_07", 5), {}, 0);
    const auto own = ResultFolder::read(results_.results(), "00000000deadbeef", "P07");
    ASSERT_EQ(own.size(), 3);
    EXPECT_EQ(own[2].number, 3);
    const std::string html =
        test::readFile(results_.results() / (fileStemOf(test::typicalResult()) + ".html"));
    EXPECT_NE(html.find("Mean of the last three"), std::string::npos);
}

TEST_F(ResultFolderTest, FilesThatAreNoResultsCostNobodyTheirReport) {
    fs::create_directories(results_.results());
    test::writeFile(results_.results() / "x_P07_1.json", "{");
    fs::create_directory(results_.results() / "y_P07_2.json");
    results_.write(test::typicalResult(), {}, 0);
    EXPECT_EQ(ResultFolder::read(results_.results(), "00000000deadbeef", "P07").size(), 1);
}

TEST_F(ResultFolderTest, WhereNothingCanBeWrittenItSaysSo) {
    test::writeFile(folder_ / "results", "a file");
    EXPECT_THROW(results_.write(test::typicalResult(), {}, 0), UserError);
}

TEST_F(ResultFolderTest, ExpertsAreThoseWhoseResultsTheTeacherPutThere) {
    fs::create_directories(results_.experts());
    for (uint32_t n = 1; n <= 5; ++n) {
        AttemptResult expert = test::typicalResult("E" + std::to_string(n), n);
        expert.assessment.figures[0].value = n;
        test::writeFile(results_.experts() / (fileStemOf(expert) + ".json"), resultJson(expert));
    }
    results_.write(test::typicalResult(), {}, 0);
    const std::string html =
        test::readFile(results_.results() / (fileStemOf(test::typicalResult()) + ".html"));
    EXPECT_NE(html.find("5 experts"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
