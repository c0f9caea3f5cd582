// haptic_bench says at once what it cannot do, not after minutes of measuring.
#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace bonemill {
namespace {

void expectRefused(const std::vector<std::string>& arguments, const std::string& words) {
    test::Process process(arguments);
    const test::Finished finished = process.wait(std::chrono::seconds(10));
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_EQ(finished.out, "");
    EXPECT_NE(finished.err.find(words), std::string::npos) << finished.err;
}

TEST(HapticBench, RefusesAFileThatCannotBeWritten) {
    const std::string none = "/no/such/folder/figures";
    const std::vector<std::vector<std::string>> commands{{"tick"}, {"scale"}, {"loop"}, {"remesh"}};
    for (std::vector<std::string> arguments : commands) {
        arguments.insert(arguments.begin(), "haptic_bench");
        arguments.insert(arguments.end(), {"--json", none});
        expectRefused(arguments, "error: " + none + ": cannot be written");
    }
    expectRefused({"haptic_bench", "scale", "--plot", none}, "error: " + none + ": cannot be written");
}

TEST(HapticBench, AFileThatExistsOutlivesAWrongCommandLine) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "figures.json", "{}");
    expectRefused({"haptic_bench", "scale", "--json", folder / "figures.json", "--runs", "0"}, "--runs");
    EXPECT_EQ(test::readFile(folder / "figures.json"), "{}");
}

TEST(HapticBench, RefusesEdgesThatItDoesNotMeasure) {
    for (const char* edge : {"127", "1025", "0", "-1"})
        expectRefused({"haptic_bench", "scale", "--largest-edge", edge}, "--largest-edge");
}

}  // namespace
}  // namespace bonemill
