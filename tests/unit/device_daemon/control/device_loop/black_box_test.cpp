#include "device_daemon/control/device_loop/black_box.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

std::vector<std::string> linesOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

constexpr int64_t kBoxPeriodNs = 1'000'000;

void record(BlackBox& box, int64_t from, int64_t to, StopCause cause, int64_t period_ns = kBoxPeriodNs) {
    for (int64_t i = from; i < to; ++i) {
        BlackBoxRecord record{};
        record.time_ns = i * period_ns;
        record.sample.sequence = uint64_t(i);
        box.record(record, cause);
    }
}

TEST(BlackBox, HoldsWhatWasBeforeAStopAndALittleAfter) {
    const test::TemporaryFolder folder;
    BlackBox box;
    record(box, 0, 5000, StopCause::kNone);
    EXPECT_FALSE(box.isFull());
    record(box, 5000, 6000, StopCause::kSpeed);
    ASSERT_TRUE(box.isFull());
    box.write(folder / "stop.csv");
    EXPECT_FALSE(box.isFull());
    const auto lines = linesOf(folder / "stop.csv");
    ASSERT_EQ(lines.size(), 2102u);
    EXPECT_EQ(lines[1].rfind("0,0,3000,", 0), 0u) << lines[1];
    EXPECT_EQ(lines[2101].rfind("2.1,0,5100,", 0), 0u) << lines[2101];
    const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    EXPECT_EQ(columns(lines[0]), columns(lines[1]));
}

TEST(BlackBox, AnEarlyStopHasFewerRecordsAndTheNextOneIsKept) {
    const test::TemporaryFolder folder;
    BlackBox box;
    record(box, 0, 10, StopCause::kNone);
    record(box, 10, 200, StopCause::kSpeed);
    ASSERT_TRUE(box.isFull());
    box.write(folder / "first.csv");
    EXPECT_EQ(linesOf(folder / "first.csv").size(), 1u + 10 + 101);
    record(box, 200, 300, StopCause::kSpeed);  // the same stop goes on
    EXPECT_FALSE(box.isFull());
    record(box, 300, 400, StopCause::kNone);
    record(box, 400, 600, StopCause::kSpeed);
    EXPECT_TRUE(box.isFull());
    box.write(folder / "second.csv");
    record(box, 600, 800, StopCause::kDeviceFault);  // another cause on top is another stop
    EXPECT_TRUE(box.isFull());
    EXPECT_EQ(box.cause(), StopCause::kDeviceFault);
}

// A period, and about how many records of it are kept in 2.1 s.
TEST(BlackBox, HoldsTwoSecondsAtEveryRate) {
    constexpr std::pair<int64_t, double> kRates[] = {
        {10'000'000, 211}, {250'000, 8401}, {100'000, 21001}, {25'000, 21001}};
    for (const auto& [period_ns, rows] : kRates) {
        const test::TemporaryFolder folder;
        BlackBox box;
        const int64_t stop = 5 * kNsPerSecond / period_ns;
        record(box, 0, stop, StopCause::kNone, period_ns);
        record(box, stop, 2 * stop, StopCause::kSpeed, period_ns);
        ASSERT_TRUE(box.isFull());
        box.write(folder / "stop.csv");
        const auto lines = linesOf(folder / "stop.csv");
        EXPECT_NEAR(double(lines.size()), 1.0 + rows, 2) << period_ns;
        EXPECT_NEAR(std::stod(lines.back()), 2.1, 2e-4) << period_ns;
    }
}

TEST(BlackBox, AStopJustBeforeTheEndIsKept) {
    const test::TemporaryFolder folder;
    BlackBox box;
    record(box, 0, 3000, StopCause::kNone);
    box.finish();
    EXPECT_FALSE(box.isFull()) << "nothing has stopped";
    record(box, 3000, 3005, StopCause::kSpeed);
    EXPECT_FALSE(box.isFull());
    box.finish();
    ASSERT_TRUE(box.isFull());
    EXPECT_EQ(box.cause(), StopCause::kSpeed);
    box.write(folder / "stop.csv");
    EXPECT_EQ(linesOf(folder / "stop.csv").size(), 1u + 2005);
    box.finish();
    EXPECT_FALSE(box.isFull()) << "it is written once";
}

TEST(BlackBox, SaysWhenItCannotBeWritten) {
    BlackBox box;
    record(box, 0, 300, StopCause::kSpeed);
    EXPECT_ANY_THROW(box.write("/no/such/folder/stop.csv"));
    EXPECT_FALSE(box.isFull());  // and goes on
}

}  // namespace
}  // namespace bonemill
