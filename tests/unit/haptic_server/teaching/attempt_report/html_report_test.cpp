#include "haptic_server/teaching/attempt_report/html_report.h"

#include <gtest/gtest.h>

#include <regex>
#include <vector>

#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"
#include "tests/unit/haptic_server/teaching/attempt_report/well_formed.h"

namespace bonemill {
namespace {

using test::wellFormed, test::withoutStyle;

TEST(HtmlReport, IsWellFormedAndNamesNobodyElsesPlace) {
    ReportExtras extras;
    extras.pictures = {{"Over- and under-cut", "image/png", "\x89PNG"}};
    for (uint32_t n = 1; n <= 7; ++n) extras.own.push_back(test::typicalResult("P07", n));
    for (size_t n = 0; n < 7; ++n) extras.own[n].assessment.total->score = 0.9 - 0.5 / double(n + 1);
    std::vector<AttemptResult> experts;
    for (uint32_t n = 1; n <= 5; ++n) {
        experts.push_back(test::typicalResult("E", n));
        experts.back().assessment.figures[0].value = n;
    }
    const AttemptResult result = test::typicalResult();
    extras.comparison = compareWith(experts, result);
    extras.begin_s = 100;
    const std::string html = htmlReport(result, extras);
    EXPECT_EQ(wellFormed(withoutStyle(html)), "");
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
    std::smatch place;
    std::string rest = html;
    while (std::regex_search(rest, place, std::regex("(src|href|url)[=(] *['\"]?([a-z]+:)"))) {
        EXPECT_EQ(place[2], "data:");
        rest = place.suffix();
    }
    EXPECT_NE(html.find("class='curve'"), std::string::npos) << "seven attempts make a curve";
    EXPECT_NE(html.find("class='band'"), std::string::npos);
    EXPECT_NE(html.find("Mean of the last three"), std::string::npos);
}

TEST(HtmlReport, ShowsGatesBeforeScoresAndScoresBeforeFigures) {
    const std::string html = htmlReport(test::typicalResult(), {});
    const size_t verdict = html.find("Not passed: 1 of 2 gates"), gates = html.find("<h2>Gates</h2>"),
                 scores = html.find("<h2>Scores</h2>"), total = html.find("47 of 100"),
                 first = html.find("How it was done"), all = html.find("All other figures");
    EXPECT_LT(verdict, gates);
    EXPECT_LT(gates, scores);
    EXPECT_LT(scores, total);
    EXPECT_LT(total, first);
    EXPECT_LT(first, all);
    EXPECT_NE(all, std::string::npos);
    EXPECT_NE(html.find("97 % of what was asked to be removed is gone"), std::string::npos);
    EXPECT_LT(html.find("force.median@1"), all);
    EXPECT_GT(html.find("time.pedal@1"), all);
    for (const char* once : {"damage.volume:nerve@1", "force.max@1"})
        EXPECT_EQ(html.find(once), std::string::npos) << "gates and scores show it already: " << once;
    EXPECT_NE(html.find("6.25 N"), std::string::npos);
    EXPECT_NE(html.find("10 → 2 N"), std::string::npos) << "the limits of a score";
}

TEST(HtmlReport, WithoutWeightsThereIsNoTotalAndWithoutGatesNoVerdict) {
    AttemptResult result = test::typicalResult();
    result.assessment.total.reset();
    result.assessment.gates.clear();
    const std::string html = htmlReport(result, {});
    EXPECT_EQ(html.find("of 100"), std::string::npos);
    EXPECT_EQ(withoutStyle(html).find("assed"), std::string::npos);
    EXPECT_NE(html.find("No gates in this task"), std::string::npos);
}

TEST(HtmlReport, TheWorstMomentsComeFirstAndCanBeSought) {
    ReportExtras extras;
    extras.begin_s = 100;
    const std::string html = htmlReport(test::typicalResult(), extras);
    const size_t damage = html.find("nerve cut"), touch = html.find("nerve touched"),
                 force = html.find("5.2 N on");
    EXPECT_LT(damage, touch);
    EXPECT_LT(touch, force);
    EXPECT_NE(html.find("--at 158.9"), std::string::npos);
    EXPECT_NE(html.find("0:58.9"), std::string::npos) << "in the attempt's time";
}

TEST(HtmlReport, NamesAreNoMarkup) {
    AttemptResult result = test::typicalResult("<script>alert(1)</script>");
    result.scene_title = "</title><img src='http://a.b/'>";
    result.assessment.moments[0].text = "<b>";
    result.assessment.figures[3].label = "\"><i>";
    const std::string html = htmlReport(result, {});
    EXPECT_EQ(wellFormed(withoutStyle(html)), "");
    for (const char* mark : {"<script", "<img", "<b>b", "<i>"})
        EXPECT_EQ(html.find(mark), std::string::npos) << mark;
}

TEST(HtmlReport, AnEmptyAttemptHasAPageToo) {
    AttemptResult result;
    result.pseudonym = "P";
    EXPECT_EQ(wellFormed(withoutStyle(htmlReport(result, {}))), "");
}

TEST(HtmlReport, AnHourIsAsLargeAsAMinute) {
    AttemptResult result = test::typicalResult();
    SeriesTable& table = result.assessment.series[0];
    for (Series* series :
         {&table.index, &table.columns[0], &table.columns[1], &table.columns[2], &table.columns[3]}) {
        series->values.resize(2048, 1.5);
        for (size_t n = 0; n < 2048; ++n)
            if (series == &table.index) series->values[n] = double(2 * (n + 1));
    }
    EXPECT_LT(htmlReport(result, {}).size(), 200'000);
}

}  // namespace
}  // namespace bonemill
