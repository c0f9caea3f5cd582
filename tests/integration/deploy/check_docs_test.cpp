// Runs tests/support/check_docs on trees that are only a few files: what does it find wrong in each, and what
// is its exit code?
#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;

// The tree has two documents, a header and a picture, in which everything is as it should be.
class CheckDocs : public testing::Test {
  protected:
    CheckDocs() {
        set("common/rt/clock.h", "");
        set("docs/images/burr.png", "");
        set("docs/teach/tool.md", "# The tool\n\n## Frame T\n\n![The burr](../images/burr.png)\n");
        readme("");
    }
    void set(const std::string& file, const std::string& content) {
        const std::filesystem::path path = root_ / file;
        std::filesystem::create_directories(path.parent_path());
        test::writeFile(path, content);
    }
    void readme(const std::string& more) {
        set("README.md",
            "# A tree\n\nThe [tool](docs/teach/tool.md#frame-t) has its time from `common/rt/clock.h`, "
            "`rt/clock.h` or\n"
            "`clock.h`; its results lie in `build/results.h`.\n\n```\ndocs/teach/tool.md\n```\n\n" +
                more);
    }
    Finished check() { return test::run({test::sourceDir() + "/tests/support/check_docs", root_.path()}); }
    // The document's first line behind the fixed ones is line 10.
    void expectFound(const std::string& more, const std::string& complaint) {
        readme(more);
        const Finished finished = check();
        EXPECT_EQ(finished.exit_code, 1) << more;
        EXPECT_EQ(finished.out, "README.md:" + complaint + "\n") << finished.err;
    }

    test::TemporaryFolder root_;
};

TEST_F(CheckDocs, ATreeInOrderPasses) {
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
}

TEST_F(CheckDocs, LinksAndAnchorsMustExist) {
    expectFound("See [this](docs/gone.md).\n", "10: the link docs/gone.md leads nowhere");
    expectFound("See [this](docs/teach/tool.md#frame-d).\n",
                "10: docs/teach/tool.md has no heading #frame-d");
    expectFound("See [this](#nowhere).\n", "10: README.md has no heading #nowhere");
}

TEST_F(CheckDocs, PathsMustExist) {
    expectFound("It is in `common/rt/gone.h`.\n", "10: there is no common/rt/gone.h");
    expectFound("It is in `rt/gone.h`.\n", "10: there is no rt/gone.h");
    expectFound("It is in `gone.h`.\n", "10: there is no gone.h");
    expectFound("It is in `common/gone`.\n", "10: there is no common/gone");
    expectFound("It is in `common/rt/{clock,gone}.h`.\n", "10: there is no common/rt/gone.h");
    expectFound("```\ncommon/gone --fast\n```\n", "11: there is no common/gone");
    // A path that begins at a folder of the root is looked up from there, not as the end of another.
    set("tests/common/other.h", "");
    expectFound("It is in `common/other.h`.\n", "10: there is no common/other.h");
}

TEST_F(CheckDocs, LinesEndInTime) {
    const std::string word = "abcdefghi ";  // 10 columns
    std::string line;
    for (int n = 0; n < 12; ++n) line += word;
    line.pop_back();
    expectFound(line + "jk\n", "10: the line has 121 columns, more than 120");
    readme("```\n" + line + "jk\n```\n\n| " + line + " |\n");
    EXPECT_EQ(check().exit_code, 0) << "code and tables may be wider";
    expectFound("Two words\nalone\n", "11: the word alone stands alone on its line");
}

TEST_F(CheckDocs, EveryPictureIsShown) {
    set("docs/images/forgotten.png", "");
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.out, "docs/images/forgotten.png: no document shows it\n");
}

TEST_F(CheckDocs, OptionsMustBeThoseOfTheProgram) {
    set("haptic_server/apps/haptic_server/main.cpp", "app.add_flag(\"--resume\");\n");
    set("haptic_server/apps/make_phantom/make_phantom.cpp", "app.add_option(\"--seed\");\n");
    set("deploy/demo", "case $1 in --seconds) ;; esac\n");
    readme(
        "`haptic_server --resume`, `deploy/demo --seconds 3`, `make_phantom [--seed S]`, `cmake --build`\n");
    EXPECT_EQ(check().exit_code, 0);
    expectFound("Say `haptic_server --seed 3`.\n", "10: haptic_server has no option --seed");
    expectFound("```\nA=1 bin/haptic_server --resume \\\n  --slow  # --no\n```\n",
                "11: bin/haptic_server has no option --slow");
    expectFound("```\ndeploy/demo --frames 3 | sort --unique\n```\n",
                "11: deploy/demo has no option --frames");
}

TEST_F(CheckDocs, EveryPackageHasItsRow) {
    set("deploy/packages.txt", "# All\ncmake  # builds\nninja-build  # is quick\n");
    set("deploy/packages-bench.txt", "r-base-core\n");
    set("docs/develop/dependencies.md",
        "# Packages\n\n| package | version in Debian 12 |\n|---|---|\n| cmake, git | 3 |\n| r-base-core | 4 "
        "|\n\n"
        "| package | version |\n|---|---|\n| esbuild | 0.25 |\n");
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.out,
              "docs/develop/dependencies.md: no row for ninja-build of deploy/packages*.txt\n"
              "docs/develop/dependencies.md: git is not in deploy/packages*.txt\n");
}

TEST_F(CheckDocs, FiguresOfAccuracyAreThoseOfTheShippedFile) {
    set("deploy/scenes/tooth_corridor.accuracy.json",
        R"({"settings": {"balanced": {"force_error_percent": 0.0545, "tick_p50_us": 62.33,)"
        R"( "tick_p99_us": 128.96, "tick_p99_9_us": 157.57}}})");
    const std::string section = "## How exact, how fast, how stable\n\n";
    readme(section + "It is right to 0.05 % in 62 µs, at p99.9 in 158\nµs a tick.\n\n## Next\n\n9 % more.\n");
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    expectFound(section + "It is right to 0.24 % in 62 µs.\n",
                "12: 0.24 % is not in deploy/scenes/tooth_corridor.accuracy.json: force_error_percent 0.05");
    expectFound(section + "It takes 62 µs.\n",
                "1: the section \"How exact, how fast, how stable\" quotes no figure in % of "
                "deploy/scenes/tooth_corridor.accuracy.json");
}

TEST_F(CheckDocs, WithoutDocumentsTheCheckIsBlind) {
    std::filesystem::remove_all(root_.path());
    std::filesystem::create_directories(root_.path());
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.out.find("the check is blind"), std::string::npos) << finished.out;
}

}  // namespace
}  // namespace bonemill
