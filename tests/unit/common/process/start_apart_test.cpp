#include "common/process/start_apart.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/support/process.h"

namespace bonemill {
namespace {

// The programs of this test are in this folder alone.
class StartApart : public testing::Test {
  protected:
    void SetUp() override { setenv("PATH", folder_.path().c_str(), 1); }
    void TearDown() override { setenv("PATH", path_.c_str(), 1); }
    void makeProgram(const std::string& script) {
        const std::string program = folder_ / "xdg-open";
        test::writeFile(program, "#!/bin/sh\n" + script);
        ASSERT_EQ(chmod(program.c_str(), 0700), 0);
    }
    const test::TemporaryFolder folder_;
    const std::string path_ = std::getenv("PATH");
};

TEST_F(StartApart, HandsTheWordsOverAndDoesNotWait) {
    makeProgram("while [ ! -e " + (folder_ / "go") + " ]; do /bin/sleep 0.02; done; echo \"$1\" > " +
                (folder_ / "part") + "; /bin/mv " + (folder_ / "part") + " " + (folder_ / "told") + "\n");
    EXPECT_TRUE(startApart({"xdg-open", "a report; with 'signs'.html"}));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "told")) << "it still waits";
    test::writeFile(folder_ / "go", "");
    for (int tries = 0; tries < 200 && !std::filesystem::exists(folder_ / "told"); ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(test::readFile(folder_ / "told"), "a report; with 'signs'.html\n");
}

TEST_F(StartApart, SaysWhereThereIsNoProgram) {
    EXPECT_FALSE(startApart({"xdg-open", "report.html"}));
}

}  // namespace
}  // namespace bonemill
