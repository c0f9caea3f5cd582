#include "haptic_server/lab/accuracy_report/report_files.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

#include "common/base/user_error.h"
#include "haptic_server/teaching/lessons/scene_folder.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/lab/accuracy_report/report_data.h"

namespace bonemill {
namespace {

using test::smallReport;

std::vector<std::vector<std::string>> cellsOf(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::string cell;
        for (const char c : line + ",") {
            if (c != ',') {
                cell += c;
                continue;
            }
            rows.back().push_back(cell);
            cell.clear();
        }
    }
    return rows;
}

std::string cellAt(const std::vector<std::vector<std::string>>& rows, size_t row, const std::string& column) {
    for (size_t n = 0; n < rows[0].size(); ++n)
        if (rows[0][n] == column) return rows[row].at(n);
    ADD_FAILURE() << "no column " << column;
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(AccuracyCsv, HasOneRowPerSettingWithItsFigures) {
    const auto rows = cellsOf(accuracyCsv(smallReport()));
    ASSERT_EQ(rows.size(), 5u);
    for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
    EXPECT_EQ(cellAt(rows, 3, "setting"), "balanced");
    EXPECT_EQ(cellAt(rows, 3, "in_force"), "true");
    EXPECT_EQ(cellAt(rows, 3, "on_pareto_front"), "true");
    EXPECT_EQ(cellAt(rows, 1, "on_pareto_front"), "false");  // thesis_2012 is the fastest, but no candidate
    EXPECT_EQ(cellAt(rows, 3, "force_error_percent"), "2");
    EXPECT_EQ(cellAt(rows, 3, "force_magnitude_error_percent"), "1");
    EXPECT_EQ(cellAt(rows, 3, "tick_p99_9_us"), "50");
    EXPECT_EQ(cellAt(rows, 3, "removed_volume_error_percent").substr(0, 3), "-10");
    EXPECT_EQ(cellAt(rows, 2, "removed_volume_error_percent"), "");  // nothing was milled
    EXPECT_EQ(cellAt(rows, 1, "plane_force_error_percent"), "");     // no closed form of its force
}

TEST(AccuracyJson, IsReadByTheServer) {
    const test::TemporaryFolder folder;
    const std::string file = folder / "accuracy_report_test.accuracy.json";
    writeTextFile(file, accuracyJson(smallReport()));
    const AccuracyFigures figures = readAccuracyFigures(file);
    ASSERT_EQ(figures.size(), 4u);
    EXPECT_NEAR(figures.at("exact").force_error_percent, 1, 1e-9);
    EXPECT_NEAR(figures.at("exact").direction_error_deg, 0.573, 1e-3);
}

TEST(Conclusions, NameWhatIsInForceAndWhatBetterCosts) {
    const auto lines = reportConclusions(smallReport());
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_TRUE(contains(lines[0], "**balanced**"));
    EXPECT_TRUE(contains(lines[0], "force error 2 %"));
    EXPECT_TRUE(contains(lines[1], "**exact**"));
    EXPECT_TRUE(contains(lines[1], "costs 30 µs more (+60 %)"));
}

TEST(Conclusions, ProposeWhatFitsTheBudget) {
    ReportData data = smallReport();
    data.budget_us = 60;
    EXPECT_TRUE(contains(reportConclusions(data)[2], "the most accurate is **balanced**"));
    EXPECT_TRUE(contains(accuracyJson(data), "\"proposal\": \"balanced\""));
    data.budget_us = 15;  // thesis_2012 would fit
    EXPECT_TRUE(
        contains(reportConclusions(data)[2], "No setting fits 15 µs: the fastest one's p99.9 is 20 µs"));
    EXPECT_TRUE(contains(accuracyJson(data), "\"proposal\": null"));
}

TEST(Conclusions, NothingIsBetterThanTheBest) {
    ReportData data = smallReport();
    data.settings[2].is_in_force = false;
    data.settings[3].is_in_force = true;
    EXPECT_TRUE(contains(reportConclusions(data)[1], "No setting"));
}

TEST(Conclusions, WarnOfTimesWithoutMilling) {
    ReportData data = smallReport();
    data.settings[1].removal = SettingFigures::Removal{0.2e-9, 0.2e-9, 2e-9};
    const auto lines = reportConclusions(data);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_TRUE(contains(lines[2], "with: fast (10 %) of the wanted volume"));
}

TEST(Conclusions, SayThatTimesOfALoadedMachineAreBounds) {
    ReportData data = smallReport();
    data.taken_share = 0.3;
    data.settings[2].longest_times.p99_9 = 175;
    const auto lines = reportConclusions(data);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_TRUE(contains(lines[2], "had 30 % of the processor"));
    EXPECT_TRUE(
        contains(lines[2], "balanced has a p99.9 from 50 µs (the shortest pass of each tick) to 175 µs"));
    data.taken_share = 0.01;
    EXPECT_EQ(reportConclusions(data).size(), 2u);
}

TEST(AccuracyCsv, HasTheWorstTickAndTheSpreadOverPlaces) {
    ReportData data = smallReport();
    data.settings[0].errors.worst = 0.9;
    data.settings[0].best_and_worst_place = {0.1, 0.4};
    const auto rows = cellsOf(accuracyCsv(data));
    EXPECT_EQ(cellAt(rows, 1, "force_error_worst_percent"), "90");
    EXPECT_EQ(cellAt(rows, 1, "force_error_best_place_percent"), "10");
    EXPECT_EQ(cellAt(rows, 1, "force_error_worst_place_percent"), "40");
    EXPECT_EQ(cellAt(rows, 2, "force_error_worst_place_percent"), "");
    EXPECT_TRUE(contains(reportText(data), " 10 .. 40 | 90 |"));
}

TEST(ReportText, HasTheTableAndSaysWhatOtherLawsErrorsAreNot) {
    const std::string text = reportText(smallReport());
    EXPECT_TRUE(contains(text, "**balanced** (in force) | ✓ |"));
    EXPECT_TRUE(contains(text, "| thesis_2012 | † |"));
    EXPECT_TRUE(contains(text, "There is no truth of it"));
    EXPECT_TRUE(contains(text, "pareto.png"));
    // Every row of the table has as many cells as its head.
    std::istringstream lines(text);
    long bars = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("| | setting", 0) == 0) bars = std::count(line.begin(), line.end(), '|');
        if (line.empty()) bars = 0;
        if (bars) {
            EXPECT_EQ(std::count(line.begin(), line.end(), '|'), bars) << line;
        }
    }
}

TEST(WriteTextFile, SaysWhereItCannotWrite) {
    try {
        writeTextFile("/dev/null/x.csv", "a");
        FAIL();
    } catch (const UserError& error) {
        EXPECT_TRUE(contains(error.what(), "/dev/null/x.csv: cannot be written"));
    }
}

TEST(TruthSummary, AddsUpTheStrokes) {
    std::vector<ProbingStroke> strokes{{"a", PosePath(3), 0}, {"b", PosePath(3), 0}};
    Truth one, two;
    one.refinement = 4, two.refinement = 2;
    one.max_penetration = 1e-5, two.max_penetration = 3e-5;
    one.answers.assign(3, {{}, {{0, 0, 3}, {0, 0, 0.01}}});
    two.answers.assign(3, {{}, {{0, 4, 0}, {0.02, 0, 0}}});
    const TruthSummary summary = summaryOf(strokes, {one, two});
    EXPECT_EQ(summary.refinement, 2);
    EXPECT_EQ(summary.max_penetration, 3e-5);
    EXPECT_EQ(summary.force_max, 4);
    EXPECT_NEAR(summary.force_rms, std::sqrt((9 + 16) / 2.0), 1e-12);
    EXPECT_NEAR(summary.torque_max, 0.02, 1e-15);
    EXPECT_EQ(summary.strokes, (std::vector<std::string>{"a", "b"}));
}

}  // namespace
}  // namespace bonemill
