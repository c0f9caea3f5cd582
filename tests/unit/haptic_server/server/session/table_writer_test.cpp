#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "common/rt/clock.h"
#include "haptic_server/teaching/lessons/class_table.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

TEST(TableWriter, AFileThatHangsKeepsNobodyWaiting) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "class.csv";
    TableWriter writer{ClassTable(path)};
    const int other = open(path.c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_EQ(flock(other, LOCK_EX), 0);
    topics::Command stop;
    stop.set_stop_attempt(true);
    stop.set_sequence(7);
    const int64_t start_ns = monotonicNowNs();
    EXPECT_TRUE(writer.write({}, "", stop));
    for (size_t n = 1; n < TableWriter::kMostWaiting; ++n) EXPECT_TRUE(writer.write({}, "", {}));
    EXPECT_FALSE(writer.write({}, "", stop)) << "there is a bound";
    EXPECT_LT(monotonicNowNs() - start_ns, kNsPerSecond);
    EXPECT_TRUE(writer.takeWritten().empty());
    ASSERT_EQ(close(other), 0);
    std::vector<TableWriter::Written> written;
    ASSERT_TRUE(test::waitFor([&] {
        written = writer.takeWritten();
        return !written.empty();
    }));
    EXPECT_EQ(written.at(0).order->sequence(), 7u);
    EXPECT_EQ(written.at(0).problem, "");
}

TEST(TableWriter, WhatCannotBeWrittenIsSaidAndTheEndWaitsForTheRest) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "class.csv";
    {
        TableWriter writer{ClassTable(path)};
        EXPECT_TRUE(writer.write({}, "", {}));
    }
    EXPECT_NE(test::readFile(path), "");
    TableWriter writer{ClassTable(path)};
    test::writeFile(path, "grades");
    EXPECT_TRUE(writer.write({}, "", topics::Command()));
    std::vector<TableWriter::Written> written;
    ASSERT_TRUE(test::waitFor([&] {
        written = writer.takeWritten();
        return !written.empty();
    }));
    EXPECT_NE(written.at(0).problem.find("other columns"), std::string::npos) << written.at(0).problem;
}

// Waits until the line with this attempt is written.
TableWriter::Written writtenBy(TableWriter& writer, const std::optional<AttemptJudgement>& judgement) {
    topics::Attempt attempt;
    attempt.set_number(3);
    attempt.set_trainee("P07");
    attempt.set_scene_id("tooth_cavity");
    attempt.set_start_stamp_ns(1'700'000'000'000'000'000);
    attempt.set_time_s(61.5);
    EXPECT_TRUE(writer.write(attempt, "Straight bore", {}, judgement));
    std::vector<TableWriter::Written> written;
    EXPECT_TRUE(test::waitFor([&] {
        written = writer.takeWritten();
        return !written.empty();
    }));
    return written.at(0);
}

AttemptJudgement failedJudgement() {
    AttemptJudgement judgement;
    judgement.judge = [] {
        JudgedAttempt judged;
        judged.assessment.figures = {{"force.max", 1, "Force", 6, "N"}};
        judged.assessment.gates = {{"g", "The nerve is whole", "damage.volume:nerve", 0, true, false, "cut"},
                                   {"h", "The target is gone", "target", 90, false, true, "gone"}};
        judged.assessment.total = Total{0.47, 1, 1, "0"};
        return judged;
    };
    judgement.scene_hash = 0xabc;
    return judgement;
}

TEST(TableWriter, AJudgedAttemptHasItsFilesBeforeItsLine) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "class.csv";
    TableWriter writer{ClassTable(path)};
    const TableWriter::Written written = writtenBy(writer, failedJudgement());
    EXPECT_EQ(written.problem, "");
    ASSERT_TRUE(written.verdict);
    EXPECT_FALSE(written.verdict->passed());
    EXPECT_EQ(written.verdict->results(), "20231114T221320Z_P07_3");
    const std::string table = test::readFile(path);
    EXPECT_TRUE(table.ends_with(",no,\"The nerve is whole\",47,\"20231114T221320Z_P07_3\",\n")) << table;
    for (const char* file : {"20231114T221320Z_P07_3.json", "20231114T221320Z_P07_3.html", "xapi.jsonl"})
        EXPECT_TRUE(std::filesystem::exists(folder / ("results/" + std::string(file)))) << file;
    EXPECT_NE(test::readFile(folder / "results/20231114T221320Z_P07_3.json").find("0000000000000abc"),
              std::string::npos);
}

TEST(TableWriter, WhatTraineesMayNotKnowIsNotTold) {
    const test::TemporaryFolder folder;
    TableWriter writer{ClassTable(folder / "class.csv")};
    AttemptJudgement judgement = failedJudgement();
    judgement.is_told = false;
    EXPECT_FALSE(writtenBy(writer, judgement).verdict);
    EXPECT_NE(test::readFile(folder / "class.csv").find(",no,"), std::string::npos)
        << "the teacher's table has it";
}

TEST(TableWriter, AnAttemptThatCannotBeJudgedHasItsLineAllTheSame) {
    const test::TemporaryFolder folder;
    TableWriter writer{ClassTable(folder / "class.csv")};
    AttemptJudgement judgement;
    judgement.judge = []() -> JudgedAttempt { throw std::runtime_error("no memory"); };
    const TableWriter::Written written = writtenBy(writer, judgement);
    EXPECT_EQ(written.problem, "no memory");
    EXPECT_NE(test::readFile(folder / "class.csv").find("P07"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
