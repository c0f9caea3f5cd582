// tests/support/run_tutorials finds what a tutorial says and what does not come out so.
#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using test::Finished;

constexpr char kBlock[] = "<!-- run -->\n```bash\necho one two three > left\ncat left\n```\n";

class RunTutorials : public testing::Test {
  protected:
    void SetUp() override {
        if (follow(kBlock).exit_code == 77) GTEST_SKIP() << "this PC grants no network of its own";
    }
    Finished follow(const std::string& tutorial) {
        test::writeFile(folder_ / "tutorial.md", "# A tutorial\n\n" + tutorial);
        return test::run({test::sourceDir() + "/tests/support/run_tutorials", "--programs", test::binDir(),
                          folder_ / "tutorial.md"});
    }
    void expectFailure(const std::string& more, const std::string& part) {
        const Finished finished = follow(more);
        EXPECT_EQ(finished.exit_code, 1) << finished.out << finished.err;
        EXPECT_NE(finished.out.find(part), std::string::npos) << finished.out;
    }

    test::TemporaryFolder folder_;
};

TEST_F(RunTutorials, WhatComesOutAsItSaysPasses) {
    const Finished finished =
        follow(std::string(kBlock) + "\n<!-- prints -->\n```text\none…three\n```\n" +
               "<!-- leaves left l*t -->\n\n<!-- run -->\n```bash\ncat left; echo $HOME\n```\n");
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    EXPECT_NE(finished.out.find("tutorial.md: 2 blocks"), std::string::npos) << finished.out;
}

TEST_F(RunTutorials, ACommandThatFailsIsNamed) {
    expectFailure("<!-- run -->\n```bash\nls nowhere\necho more\n```\n", "does not end well");
}

TEST_F(RunTutorials, AnotherOutputIsNamedWithWhatCame) {
    const std::string block = kBlock;
    expectFailure(block + "<!-- prints -->\n```text\none three\n```\n", "It printed:\none two three");
    expectFailure(block + "<!-- prints -->\n```text\nthree\none\n```\n", "says that it prints:\nthree");
}

TEST_F(RunTutorials, WhatABackgroundProgramPrintsLaterIsWaitedFor) {
    const Finished finished =
        follow("<!-- run -->\n```bash\n(sleep 1; echo late) &\n```\n<!-- prints -->\n```text\nlate\n```\n");
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
}

TEST_F(RunTutorials, AFileThatIsMissingOrEmptyIsNamed) {
    const std::string block = kBlock;
    expectFailure(block + "<!-- leaves gone -->\n", "there is gone now");
    expectFailure("<!-- run -->\n```bash\ntouch empty\n```\n<!-- leaves empty -->\n", "there is empty now");
}

TEST_F(RunTutorials, ATutorialWithoutABlockIsNoTutorial) {
    expectFailure("```bash\nls\n```\n", "the check is blind");
}

}  // namespace
}  // namespace bonemill
