#include "common/attempts_csv/attempts_csv.h"

#include <gtest/gtest.h>

#include "common/text/csv_text.h"
#include "tests/support/class_lesson.h"

namespace bonemill {
namespace {

TEST(AttemptsCsv, HasALinePerAttemptBelowTheHeader) {
    const std::string text = attemptsCsv(test::makeLesson());
    EXPECT_EQ(text, attemptsHeaderLine() +
                        "1,2026-11-23T19:00:00Z,\"Anna\",\"Cavity in a "
                        "molar\",151,12.34,5.1,,,,0.2,48.5,\"\",\"none\",,\"\",,\"\",\n"
                        "2,2026-11-23T19:00:00Z,\"'=Ben\",\"Cavity in a "
                        "molar\",151,12.34,5.1,,,,0.2,48.5,\"pulp\",\"none\",,\"\",,\"\",\n");
    EXPECT_EQ(attemptsCsv({}), attemptsHeaderLine());
    EXPECT_TRUE(attemptsHeaderLine().starts_with("\xEF\xBB\xBF"));
}

TEST(AttemptsCsv, NoNameIsAFormulaOrBreaksItsLine) {
    EXPECT_EQ(csvText("Ann \"the\" drill"), "\"Ann \"\"the\"\" drill\"");
    for (const std::string text : {"=1+2", "+1", "-1", "@SUM(A1)"})
        EXPECT_EQ(csvText(text), "\"'" + text + "\"");
    EXPECT_EQ(csvText("a\nb\rc"), "\"a b c\"");
}

TEST(AttemptsCsv, ATimeThatIsNotKnownStaysEmpty) {
    topics::Attempt attempt;
    attempt.set_start_stamp_ns(-1);
    EXPECT_EQ(attemptLine(attempt, "cavity").find("0,,"), 0u);
}

TEST(AttemptsCsv, WhatAnExaminationKeepsBackIsNoZero) {
    topics::Attempt attempt;
    attempt.set_time_s(61);
    attempt.set_is_exam(true);
    EXPECT_NE(attemptLine(attempt, "clay").find(",61,,,"), std::string::npos) << attemptLine(attempt, "clay");
}

TEST(AttemptsCsv, NothingTouchedIsToldFromNothingToTouch) {
    topics::Attempt attempt;
    EXPECT_NE(attemptLine(attempt, "clay").find(",,,,,,\"\",\"\""), std::string::npos);
    attempt.mutable_training()->set_damaged_mm3(0);
    EXPECT_NE(attemptLine(attempt, "tooth").find(",0,none,,,,\"none\",\"none\""), std::string::npos)
        << attemptLine(attempt, "tooth");
}

}  // namespace
}  // namespace bonemill
