#include "haptic_server/session/table_writer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/rt/clock.h"
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
    EXPECT_EQ(written.at(0).order.sequence(), 7u);
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

}  // namespace
}  // namespace bonemill
