#include "haptic_server/teaching/attempt_report/class_page.h"

#include <gtest/gtest.h>

#include "haptic_server/teaching/attempt_report/result_folder.h"
#include "tests/support/process.h"
#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"
#include "tests/unit/haptic_server/teaching/attempt_report/well_formed.h"

namespace bonemill {
namespace {

AttemptResult attempt(const std::string& who, uint32_t number, double score, bool is_nerve_whole) {
    AttemptResult result = test::typicalResult(who, number);
    result.assessment.total->score = score;
    result.assessment.gates[0].is_passed = is_nerve_whole;
    result.assessment.gates[1].is_passed = true;
    return result;
}

size_t countOf(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(ClassPage, TellsWhatWasFailedMostAndHowEachTraineeCameOn) {
    std::vector<AttemptResult> results = {attempt("Ann", 1, 0.2, false), attempt("Ann", 2, 0.4, false),
                                          attempt("Ann", 3, 0.8, true), attempt("Ann", 4, 0.9, true),
                                          attempt("Bo", 5, 0.6, true)};
    const std::string page = classPage(results, "results");
    EXPECT_EQ(test::wellFormed(test::withoutStyle(page)), "");
    EXPECT_NE(page.find("5 attempts of 2 trainees, 3 passed"), std::string::npos);
    EXPECT_NE(page.find("The nerve is whole"), std::string::npos);
    EXPECT_NE(page.find("2 of 5"), std::string::npos);
    EXPECT_EQ(page.find("Most of the target is gone"), std::string::npos) << "nobody failed it";
    EXPECT_NE(page.find(">70<"), std::string::npos) << "Ann's mean of the last three";
    EXPECT_NE(page.find(">90<"), std::string::npos) << "Ann's best";
    EXPECT_EQ(countOf(page, "href='results/"), 5);
    EXPECT_NE(page.find("<figcaption>Ann</figcaption>"), std::string::npos);
    EXPECT_EQ(page.find("<figcaption>Bo</figcaption>"), std::string::npos) << "one attempt makes no curve";
}

TEST(ClassPage, ScenesAreKeptApartAndNamesAreNoMarkup) {
    std::vector<AttemptResult> results = {attempt("<script>", 1, 0.2, true), attempt("B", 2, 0.4, true)};
    results[1].scene_hash = "another";
    results[1].scene_title = "Pedicle & canal";
    const std::string page = classPage(results, "results");
    EXPECT_EQ(countOf(page, "1 attempts of 1 trainees"), 2);
    EXPECT_NE(page.find("Pedicle &amp; canal"), std::string::npos);
    EXPECT_EQ(page.find("<script>"), std::string::npos);
    EXPECT_EQ(test::wellFormed(test::withoutStyle(page)), "");
    EXPECT_EQ(test::wellFormed(test::withoutStyle(classPage({}, "results"))), "");
}

TEST(ClassPage, FollowsEachAttemptAndForgetsAPerson) {
    const test::TemporaryFolder folder;
    const ResultFolder results(folder / ".");
    results.write(attempt("Ann", 1, 0.2, false), {}, 0);
    results.write(attempt("Bo", 2, 0.4, true), {}, 0);
    results.writeClassPage();
    std::string page = test::readFile(results.classPage());
    EXPECT_NE(page.find("Ann"), std::string::npos);
    EXPECT_NE(page.find("Bo"), std::string::npos);
    EXPECT_TRUE(forgetResults(folder / ".", "Ann").problems.empty());
    page = test::readFile(results.classPage());
    EXPECT_EQ(page.find("Ann"), std::string::npos);
    EXPECT_NE(page.find("Bo"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
