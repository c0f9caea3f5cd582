#include "device_daemon/loop/black_box.h"

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

void record(BlackBox& box, int64_t from, int64_t to, StopCause cause) {
    for (int64_t i = from; i < to; ++i) {
        BlackBoxRecord record{};
        record.time_ns = i * 1'000'000;
        record.sample.sequence = uint64_t(i);
        box.record(record, cause);
    }
}

TEST(BlackBox, HoldsWhatWasBeforeAStopAndALittleAfter) {
    const test::TemporaryFolder folder;
    BlackBox box(2000);
    record(box, 0, 5000, StopCause::kNone);
    EXPECT_FALSE(box.isFull());
    record(box, 5000, 6000, StopCause::kSpeed);
    ASSERT_TRUE(box.isFull());
    box.write(folder / "stop.csv");
    EXPECT_FALSE(box.isFull());
    const auto lines = linesOf(folder / "stop.csv");
    ASSERT_EQ(lines.size(), 2001u);
    EXPECT_EQ(lines[1].rfind("0,0,3100,", 0), 0u) << lines[1];
    EXPECT_EQ(lines[2000].rfind("1.999,0,5099,", 0), 0u) << lines[2000];
    const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    EXPECT_EQ(columns(lines[0]), columns(lines[1]));
}

TEST(BlackBox, AnEarlyStopHasFewerRecordsAndTheNextOneIsKept) {
    const test::TemporaryFolder folder;
    BlackBox box(2000);
    record(box, 0, 10, StopCause::kNone);
    record(box, 10, 200, StopCause::kSpeed);
    ASSERT_TRUE(box.isFull());
    box.write(folder / "first.csv");
    EXPECT_EQ(linesOf(folder / "first.csv").size(), 1u + 10 + BlackBox::kAfterRecords);
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

TEST(BlackBox, SaysWhenItCannotBeWritten) {
    BlackBox box(200);
    record(box, 0, 300, StopCause::kSpeed);
    EXPECT_ANY_THROW(box.write("/no/such/folder/stop.csv"));
    EXPECT_FALSE(box.isFull());  // and goes on
}

}  // namespace
}  // namespace bonemill
