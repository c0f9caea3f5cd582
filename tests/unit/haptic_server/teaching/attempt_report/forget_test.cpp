#include <gtest/gtest.h>

#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"
#include "tests/support/process.h"
#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

TEST(Forget, NothingOfAPersonIsLeftAndAllOfTheOthers) {
    const test::TemporaryFolder folder;
    const fs::path root = folder / ".";
    const ResultFolder results(root);
    for (uint32_t n = 1; n <= 2; ++n) results.write(test::typicalResult("P07", n), {}, 0);
    test::writeFile(results.results() / (fileStemOf(test::typicalResult("P07", 2)) + ".png"), "P07's bone");
    AttemptResult other = test::typicalResult("P0", 3);
    other.journal = "other.mcap";
    results.write(other, {}, 0);
    fs::create_directories(results.experts());
    test::writeFile(results.experts() / "renamed.json", resultJson(test::typicalResult("P07", 9)));

    const Forgotten forgotten = forgetResults(root, "P07");
    EXPECT_TRUE(forgotten.problems.empty());
    EXPECT_EQ(forgotten.deleted.size(), 2 * 2 + 1 + 1 + 1);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
        if (!entry.is_regular_file()) continue;
        EXPECT_EQ(test::readFile(entry.path()).find("P07"), std::string::npos) << entry.path();
    }
    EXPECT_TRUE(fs::exists(results.results() / (fileStemOf(other) + ".html")));
    EXPECT_NE(test::readFile(results.statements()).find("\"P0\""), std::string::npos);
    EXPECT_TRUE(forgetResults(root, "P07").deleted.empty()) << "there is nothing left";
}

}  // namespace
}  // namespace bonemill
