#include "haptic_server/teaching/lessons/class_table.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>

#include "common/attempts_csv/attempts_csv.h"
#include "common/base/user_error.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

topics::Attempt attemptOf(const std::string& trainee) {
    topics::Attempt attempt;
    attempt.set_number(3);
    attempt.set_trainee(trainee);
    attempt.set_scene_id("tooth_cavity");
    attempt.set_start_stamp_ns(1'700'000'000'000'000'000);
    attempt.set_time_s(61.5);
    attempt.set_removed_mm3(12.25);
    attempt.set_max_force_n(4);
    attempt.mutable_training()->set_damaged_mm3(0);
    attempt.add_structures_touched("pulp");
    attempt.add_structures_touched("nerve, left");
    return attempt;
}

class ClassTableTest : public testing::Test {
  protected:
    std::string path() const { return folder_ / "class.csv"; }
    std::string content() const { return test::readFile(path()); }
    const test::TemporaryFolder folder_;
};

const std::string kHeader = attemptsHeaderLine();
const std::string kAnn =
    "3,2023-11-14T22:13:20Z,\"Ann\",\"Straight bore, molar\",61.5,12.25,4,0,none,,,,\"pulp; nerve, "
    "left\",\"none\",,\"\",,\"\",\n";

TEST_F(ClassTableTest, EachAttemptIsAWholeLineBelowTheHeader) {
    const ClassTable table(path());
    EXPECT_EQ(table.append(attemptOf("Ann"), "Straight bore, molar"), "");
    EXPECT_EQ(content(), kHeader + kAnn);
    EXPECT_EQ(ClassTable(path()).append(attemptOf("Ann"), "Straight bore, molar"), "");
    EXPECT_EQ(content(), kHeader + kAnn + kAnn);
    EXPECT_EQ(table.append(attemptOf("Ann"), "Straight bore, molar", "0a1b"), "");
    EXPECT_TRUE(content().ends_with(",\"\",0a1b\n")) << "the recording's link";
}

TEST_F(ClassTableTest, AnotherFileIsNotTouched) {
    test::writeFile(path(), "grades of 2026\n");
    EXPECT_THROW(ClassTable{path()}, UserError);
    EXPECT_EQ(content(), "grades of 2026\n");
    EXPECT_THROW(ClassTable(folder_ / "no folder/class.csv"), UserError);
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    EXPECT_THROW(ClassTable(folder_ / "pipe"), UserError);
    EXPECT_THROW(ClassTable("/dev/null"), UserError);
}

// An earlier release had no verdicts: its table keeps the columns that it has.
TEST_F(ClassTableTest, ATableOfAnEarlierReleaseGoesOn) {
    const std::string header = kHeader.substr(0, kHeader.find(",passed")) + "\n";
    test::writeFile(path(), header);
    EXPECT_EQ(ClassTable(path()).append(attemptOf("Ann"), "Straight bore, molar"), "");
    EXPECT_EQ(content(), header + kAnn.substr(0, kAnn.size() - 10) + "\n");
    test::writeFile(path(), kHeader.substr(0, kHeader.find(",scene")) + "\n");
    EXPECT_THROW(ClassTable{path()}, UserError) << "fewer columns than there ever were";
}

TEST_F(ClassTableTest, APersonIsForgottenAndNobodyElse) {
    const ClassTable table(path());
    for (const char* name : {"P07", "P0", "P07", "=1+1", "say \"P07\", please", "P077"})
        EXPECT_EQ(table.append(attemptOf(name), "P07"), "");
    EXPECT_EQ(ClassTable::forget(path(), "P07"), 2u);
    EXPECT_EQ(ClassTable::forget(path(), "P07"), 0u);
    EXPECT_EQ(std::ranges::count(content(), '\n'), 5);
    EXPECT_EQ(ClassTable::forget(path(), "=1+1"), 1u);
    EXPECT_EQ(ClassTable::forget(path(), "say \"P07\", please"), 1u);
    test::writeFile(path(), kHeader + "1,now,P9,scene,1\r\n2,now,P8,scene,1");  // as a spreadsheet writes it
    EXPECT_EQ(ClassTable::forget(path(), "P9"), 1u);
    EXPECT_EQ(ClassTable::forget(path(), "P8"), 1u);
    EXPECT_EQ(content(), kHeader);
    EXPECT_TRUE(ClassTable::isTable(path()));
    test::writeFile(path(), "grades\n");
    EXPECT_FALSE(ClassTable::isTable(path()));
    EXPECT_THROW(ClassTable::forget(path(), "P9"), UserError);
}

TEST_F(ClassTableTest, ALineWithoutItsEndIsNotContinued) {
    test::writeFile(path(), kHeader + "1,somebody's");
    EXPECT_EQ(ClassTable(path()).append(attemptOf("Ann"), "Straight bore, molar"), "");
    EXPECT_EQ(content(), kHeader + "1,somebody's\n" + kAnn);
}

TEST_F(ClassTableTest, AFullDiskIsToldOfAndLeavesWholeLines) {
    const ClassTable table(path());
    ASSERT_EQ(table.append(attemptOf("Ann"), "Straight bore, molar"), "");
    const std::string before = content();
    const rlimit full{before.size() + 10, RLIM_INFINITY};
    rlimit unlimited{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
    signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
    const std::string problem = table.append(attemptOf("Bob"), "Straight bore, molar");
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
    EXPECT_NE(problem.find("cannot be written"), std::string::npos) << problem;
    EXPECT_EQ(content(), before);
}

}  // namespace
}  // namespace bonemill
