#include <gtest/gtest.h>

#include "device_daemon/control/device_loop/black_box.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

std::string stopName(int milliseconds) {
    return "stop_7_2026-11-23_04-05-06_" + std::to_string(milliseconds) + "_motor_too_hot.csv";
}

TEST(StopFiles, TheNewestStayAndWhatIsNotOneStaysToo) {
    const test::TemporaryFolder folder;
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (int i = 0; i < 120; ++i) {
        const std::string file = folder / stopName(i);
        test::writeFile(file, "");
        fs::last_write_time(file, old + std::chrono::seconds(i));
    }
    test::writeFile(folder / "notes.csv", "");
    fs::last_write_time(folder / "notes.csv", old - std::chrono::hours(1));
    test::writeFile(folder / "stop_motion.csv", "");
    fs::last_write_time(folder / "stop_motion.csv", old - std::chrono::hours(1));
    fs::create_symlink(folder / "notes.csv", folder / stopName(120));

    test::writeFile(stopFile(folder.path(), 7, StopCause::kSpeed), "");
    size_t stops = 0;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        stops += entry.is_regular_file() && !entry.is_symlink();
    EXPECT_EQ(stops, kMaxStopFiles + 2) << "and the user's own";
    EXPECT_FALSE(fs::exists(folder / stopName(20)));
    EXPECT_TRUE(fs::exists(folder / stopName(21)));
    EXPECT_TRUE(fs::exists(folder / "notes.csv"));
    EXPECT_TRUE(fs::exists(folder / "stop_motion.csv"));
}

// Among the files of whoever runs the tests, the oldest would go to make room for theirs.
TEST(StopFiles, OfProgramsUnderTestGoToAFolderOfTheirOwn) {
    const test::Finished finished = test::run({"/usr/bin/printenv", "XDG_STATE_HOME"});
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_EQ(finished.out.rfind(fs::temp_directory_path().string(), 0), 0u) << finished.out;
}

TEST(StopFiles, AFolderThatCannotBeMadeIsNoError) {
    EXPECT_EQ(stopFile("/proc/nowhere", 7, StopCause::kSpeed).parent_path(), "/proc/nowhere");
}

}  // namespace
}  // namespace bonemill
