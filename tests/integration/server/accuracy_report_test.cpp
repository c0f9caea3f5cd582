// Runs `bonemill_lab accuracy-report` from outside, on a tiny scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;
using test::readFile;
using test::run;
using test::TemporaryFolder;
using test::writeFile;

class AccuracyReport : public testing::Test {
  protected:
    AccuracyReport() {
        const auto made = run({"make_phantom", "body", "--kind", "sphere", "--radius-mm", "3", "--dims", "40",
                               "40", "40", "--out", folder_ / "ball.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        // There are few ticks per second of path: this test is about files, not figures.
        writeFile(folder_ / "s.textproto",
                  "name: \"tiny\" volume { path: \"ball.nrrd\" } loop { rate_hz: 250 }");
    }
    std::vector<std::string> arguments(const std::string& out) {
        return {"bonemill_lab",          "accuracy-report", "--scene",
                folder_ / "s.textproto", "--out",           folder_ / out};
    }
    bool isThere(const std::string& file) { return std::filesystem::exists(folder_ / file); }

    TemporaryFolder folder_;
};

long linesOf(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

TEST_F(AccuracyReport, WritesAllFilesAndProposesWithinTheBudget) {
    std::vector<std::string> call = arguments("deep/er");
    call.insert(call.end(), {"--budget-us", "1e6"});
    const Finished finished = run(call);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_NE(finished.out.find("In force in this scene: **balanced**"), std::string::npos) << finished.out;
    EXPECT_NE(finished.out.find("Within 1e+06 µs the most accurate is"), std::string::npos) << finished.out;

    const auto json = nlohmann::json::parse(readFile(folder_ / "deep/er/accuracy.json"));
    EXPECT_EQ(json["scene"], "tiny");
    EXPECT_EQ(json["in_force"], "balanced");
    const auto& settings = json["settings"];
    EXPECT_GE(settings.size(), 18u);
    for (const char* preset : {"thesis_2012", "fast", "balanced", "exact"})
        ASSERT_TRUE(settings.contains(preset));
    EXPECT_TRUE(settings["balanced"]["in_force"].get<bool>());
    EXPECT_FALSE(settings["thesis_2012"]["on_pareto_front"].get<bool>());
    EXPECT_TRUE(settings["exact"]["removed_volume_error_percent"].is_null());  // the scene does not mill
    EXPECT_GT(settings["fast"]["force_error_percent"].get<double>(),
              settings["exact"]["force_error_percent"].get<double>());
    // On a ball of 0.25 mm voxels, with some 3 voxels of contact, the exact preset is not far off.
    EXPECT_LT(settings["exact"]["force_error_percent"].get<double>(), 5);
    EXPECT_GT(json["truth"]["force_rms_n"].get<double>(), 0.5);
    EXPECT_LT(json["truth"]["force_max_n"].get<double>(), 5);
    EXPECT_GE(settings["exact"]["closed_path_energy_uj"].get<double>(), 0);
    bool any_on_front = false;
    for (const auto& figures : settings) any_on_front |= figures["on_pareto_front"].get<bool>();
    EXPECT_TRUE(any_on_front);
    EXPECT_TRUE(settings.contains(json["proposal"].get<std::string>()));

    EXPECT_EQ(linesOf(readFile(folder_ / "deep/er/accuracy.csv")), long(settings.size()) + 1);
    EXPECT_GT(linesOf(readFile(folder_ / "deep/er/patch.csv")), 10);
    EXPECT_NE(readFile(folder_ / "deep/er/report.md").find("# Accuracy and time: tiny"), std::string::npos);
    EXPECT_EQ(readFile(folder_ / "deep/er/pareto.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
    // Progress is one line per setting.
    for (size_t n = 1; n <= settings.size(); ++n) {
        char mark[32];
        std::snprintf(mark, sizeof mark, "[%2zu/%zu] ", n, settings.size());
        EXPECT_NE(finished.err.find(mark), std::string::npos) << mark << finished.err;
    }
    EXPECT_NE(finished.err.find(" s left"), std::string::npos);
}

// One that takes longer than another is measured alone, and what ends too early leaves what it has.
TEST_F(AccuracyReport, MeasuresWhatIsAskedForAndKeepsWhatItHas) {
    std::vector<std::string> call = arguments("some");
    call.insert(call.end(), {"--setting", "FAST", "--setting", "exact"});
    test::Process process(call);
    ASSERT_TRUE(test::waitFor([&] { return process.errSoFar().find("[ 1/3] ") != std::string::npos; }));
    process.signal(SIGKILL);
    EXPECT_EQ(process.wait().exit_code, 128 + SIGKILL);
    EXPECT_NE(process.errSoFar().find("strokes; about "), std::string::npos) << process.errSoFar();
    EXPECT_GE(linesOf(readFile(folder_ / "some/accuracy.csv")), 2);
    EXPECT_NE(readFile(folder_ / "some/report.md").find(" of 3 settings are measured"), std::string::npos);
    EXPECT_FALSE(isThere("some/accuracy.json"));
}

TEST_F(AccuracyReport, WithoutGnuplotTheFiguresAreWrittenAllTheSame) {
    std::vector<std::string> call = arguments("out");
    call.insert(call.end(), {"--setting", "fast"});
    call[0] = test::binDir() + "/bonemill_lab";
    call.insert(call.begin(), {"/usr/bin/env", "PATH=" + folder_.path().string()});
    const Finished finished = run(call);
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_NE(finished.err.find("error: gnuplot cannot be run"), std::string::npos) << finished.err;
    EXPECT_EQ(linesOf(readFile(folder_ / "out/accuracy.csv")), 3) << "fast, and the scene's own";
    EXPECT_NE(readFile(folder_ / "out/report.md").find("# Accuracy and time: tiny"), std::string::npos);
    EXPECT_FALSE(isThere("out/pareto.png"));
}

TEST_F(AccuracyReport, BadInputIsOneClearLine) {
    const auto expectRefused = [&](std::vector<std::string> call, const std::string& words) {
        const Finished finished = run(call);
        EXPECT_EQ(finished.exit_code, 2) << finished.err;
        EXPECT_EQ(finished.out, "");
        EXPECT_NE(finished.err.find(words), std::string::npos) << finished.err;
    };
    writeFile(folder_ / "file", "");
    expectRefused(arguments("file/below"), "--out ");
    writeFile(folder_ / "bad.textproto", "volume { path: \"ball.nrrd\" } accuracy { iterations: 99 }");
    std::vector<std::string> call = arguments("out");
    call[3] = folder_ / "bad.textproto";
    expectRefused(call, "accuracy.iterations");
    call[3] = folder_ / "nowhere.textproto";
    expectRefused(call, "nowhere.textproto");
    call = arguments("unnamed");
    call.insert(call.end(), {"--setting", "exacter"});
    expectRefused(call, "--setting exacter: there is no such setting; there are\n  thesis_2012\n  fast\n");
    for (const char* budget : {"0", "-5", "soon"}) {
        call = arguments("out");
        call.insert(call.end(), {"--budget-us", budget});
        expectRefused(call, "--budget-us");
    }
    expectRefused({"bonemill_lab", "accuracy-report", "--scene", folder_ / "s.textproto"}, "--out");
    EXPECT_FALSE(isThere("out"));
}

TEST_F(AccuracyReport, BoneThatCannotBeTouchedIsSaid) {
    writeFile(folder_ / "s.textproto",
              "volume { path: \"ball.nrrd\" window_low: -1e6 window_high: 1e6 iso_value: 9e5 } loop { "
              "rate_hz: 250 }");
    const Finished finished = run(arguments("out"));
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_NE(finished.err.find("touches no bone"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace bonemill
