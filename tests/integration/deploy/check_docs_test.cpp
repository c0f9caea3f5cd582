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
        set("docs/reference/tool.md", "# The tool\n\n## Frame T\n\n![The burr](../images/burr.png)\n");
        readme("");
    }
    void set(const std::string& file, const std::string& content) {
        const std::filesystem::path path = root_ / file;
        std::filesystem::create_directories(path.parent_path());
        test::writeFile(path, content);
    }
    void readme(const std::string& more) {
        set("README.md",
            "# A tree\n\nThe [tool](docs/reference/tool.md#frame-t) has its time from `common/rt/clock.h`, "
            "`rt/clock.h` or\n"
            "`clock.h`; its results lie in `build/results.h`.\n\n```\ndocs/reference/tool.md\n```\n\n" +
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
    expectFound("See [this](docs/reference/tool.md#frame-d).\n",
                "10: docs/reference/tool.md has no heading #frame-d");
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

TEST_F(CheckDocs, WhatAProgramIsSaidToSayStandsInASource) {
    set("haptic_server/apps/main.cpp",
        "throw UserError(path + \": the disk is \"\n    \"full; tidy up\");\n");
    set("deploy/start", "fail \"$1 is gone\"\n");
    readme("It says “: the disk is full; tidy up”, “the disk … tidy up” and “is gone”.\n");
    EXPECT_EQ(check().exit_code, 0) << check().out;
    expectFound("| “the disk is empty” | do |\n", "10: no source says “the disk is empty”");
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

// The tree has a file of figures, too, and the script that fills them in.
class CheckFigures : public CheckDocs {
  protected:
    CheckFigures() {
        set("haptic_server/core/tick.cpp", "int tick() { return 1; }\n");
        set("docs/figures.json",
            R"({"machine": "A PC, 2 cores", "commit": "0123abcd", "date": "2026-11-27", "code": {}, "accepted": [],)"
            R"( "benches": {"accuracy.tooth": {"figures": {"balanced.error_percent": [0.0545, 0.05, 0.06],)"
            R"( "balanced.p50_us": [62.33, 61, 63], "fast, s = 3.error_percent": [9.7, 9, 10],)"
            R"( "fast, s = 3.p50_us": [31, 30, 32]}}}})");
        std::filesystem::create_directories(root_ / "deploy");
        for (const char* file : {"deploy/measure", "deploy/figures.py"})
            std::filesystem::copy(std::filesystem::path(test::sourceDir()) / file, root_ / file);
        measure("--accept", "made for a test");
    }
    void measure(const std::string& option, const std::string& why = "") {
        std::vector<std::string> words{root_ / "deploy/measure", option};
        if (!why.empty()) words.push_back(why);
        const Finished finished = test::run(words);
        ASSERT_EQ(finished.exit_code, 0) << finished.out << finished.err;
    }
    void expectInOrder(const std::string& more) {
        readme(more);
        const Finished finished = check();
        EXPECT_EQ(finished.exit_code, 0) << more << finished.out << finished.err;
    }
};

const std::string kTable =
    "<!--=table accuracy.tooth.{}.error_percent - .p50_us-->\n| setting | error | p50 |\n|---|---|---|\n";

TEST_F(CheckFigures, AreRoundedAsTheTextShowsThem) {
    expectInOrder(
        "It takes **62**<!--=accuracy.tooth.balanced.p50_us--> µs, "
        "62.3<!--=accuracy.tooth.balanced.p50_us-->\n"
        "to be exact, on 2026-11-27<!--=date--> (A PC, 2 cores)<!--=machine-->.\n");
    expectFound("It takes 63<!--=accuracy.tooth.balanced.p50_us--> µs.\n",
                "10: 63 is 62 in docs/figures.json: accuracy.tooth.balanced.p50_us");
    expectFound("It is of 2026-11-23<!--=date-->.\n",
                "10: 2026-11-23 is 2026-11-27 in docs/figures.json: date");
}

TEST_F(CheckFigures, MayBeTheBenchmarks) {
    set("docs/benchmark.json",
        R"({"programs": [{"name": "ours best", "figures": {"z_width": {"value": 16.03, "unit": "N/mm"}},)"
        R"( "scenes": {"peg": {"force_error": {"value": 0.396, "unit": "%"},)"
        R"( "false_friction": {"value": null, "unit": "%"}}}}]})");
    expectInOrder(
        "It is 0.4<!--=benchmark.ours best.peg.force_error--> % off, 16<!--=benchmark.ours best.z_width--> "
        "N/mm.\n");
    expectFound("It is 0.5<!--=benchmark.ours best.peg.force_error--> % off.\n",
                "10: 0.5 is 0.4 in docs/benchmark.json: benchmark.ours best.peg.force_error");
    expectFound("It has 1<!--=benchmark.ours best.peg.false_friction--> %.\n",
                "10: docs/benchmark.json has no figure benchmark.ours best.peg.false_friction");
}

TEST_F(CheckFigures, InATableFollowOneAnother) {
    expectInOrder(kTable +
                  "| `balanced` (default) | **0.05 %** of 2 | 62 |\n| fast, s = 3 | 9.7 % of 2 | 31 |\n");
    expectFound(kTable + "| `balanced` | 0.05 % of 2 | 61 |\n",
                "13: 61 is 62 in docs/figures.json: accuracy.tooth.balanced.p50_us");
    expectFound(kTable + "| `balanced` | 0.05 % | 62 |\n",
                "13: the row balanced has 2 numbers, its table's mark 3 names");
    readme(kTable + "| `exact` | 0.05 % of 2 | 62 |\n");
    EXPECT_NE(check().out.find("docs/figures.json has no figure accuracy.tooth.exact.p50_us"),
              std::string::npos);
}

TEST_F(CheckFigures, MustBeThereAndStandBehindANumber) {
    expectFound("It takes 62<!--=accuracy.tooth.exact.p50_us--> µs.\n",
                "10: docs/figures.json has no figure accuracy.tooth.exact.p50_us");
    expectFound("It takes long<!--=accuracy.tooth.balanced.p50_us-->.\n",
                "10: the mark accuracy.tooth.balanced.p50_us does not stand behind a figure");
    expectFound("## How exact, how fast, how stable\n\nIt takes 62 µs.\n",
                "12: 62 µs has no mark of docs/figures.json or docs/benchmark.json");
}

TEST_F(CheckFigures, AreOldWhenTheTickHasOtherCode) {
    const std::string quote = "It takes 62<!--=accuracy.tooth.balanced.p50_us--> µs.\n";
    set("haptic_server/core/tick.cpp", "// Ticks.\nint tick() {\n    return 1;\n}\n");
    expectInOrder(quote);  // neither a comment nor a line break takes time
    set("haptic_server/core/tick.cpp", "int tick() { return 2; }\n");
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(
        finished.out,
        "docs/figures.json: measured at 0123abcd, 2026-11-27; the tick's code has changed since, in "
        "haptic_server/core: deploy/measure, or deploy/measure --accept WHY where that moves no figure\n");
    measure("--accept", "2 takes as long as 1");
    EXPECT_EQ(check().exit_code, 0);
    EXPECT_NE(test::readFile(root_ / "docs/figures.json").find("2 takes as long as 1"), std::string::npos);
}

TEST_F(CheckFigures, AreFilledIntoTheTexts) {
    const std::string texts = "It takes 7<!--=accuracy.tooth.balanced.p50_us--> µs.\n\n" + kTable;
    readme(texts + "| `balanced` | 1.00 % of 2 | 1.0 |\n");
    measure("--texts");
    const std::string written = test::readFile(root_ / "README.md");
    EXPECT_NE(written.find("It takes 62<!--"), std::string::npos) << written;
    EXPECT_NE(written.find("| `balanced` | 0.05 % of 2 | 62.3 |"), std::string::npos) << written;
    EXPECT_EQ(check().exit_code, 0);
}

TEST_F(CheckFigures, OfAnotherMachineAreNotMixedWithNewOnes) {
    const Finished finished = test::run({root_ / "deploy/measure", "--only", "tick"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.err,
              "measure: docs/figures.json is of another machine (A PC, 2 cores) or of other code of the "
              "tick: measure all\n");
}

TEST_F(CheckFigures, OfThePanelAreTheSame) {
    set("deploy/scenes/tooth.accuracy.json",
        R"({"settings": {"balanced": {"error_percent": 0.06, "p50_us": 62.33}}})");
    readme("");
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.out,
              "deploy/scenes/tooth.accuracy.json: balanced: error_percent is 0.0545 in docs/figures.json\n");
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
