#include "haptic_server/recording/statistics/tick_columns.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <span>

#include "haptic_server/core/effects/effect_figures.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

RecordedEffects all() {
    RecordedEffects recorded;
    forEachConfig([&]<class Config>() { recorded.include(recordedBy<Config>()); });
    return recorded;
}

std::string namesOfEffectsWith(const EffectFigure& figure) {
    std::string names;
    forEachConfig([&]<class Config>() {
        if (figure.isToldBy(recordedBy<Config>()))
            names += (names.empty() ? "`" : ", `") + std::string(Config::kName) + "`";
    });
    return names;
}

std::string tableOfEffects() {
    std::string table;
    const std::vector<TickColumn> columns = tickColumns(all());
    for (const TickColumn& column : std::span(columns).subspan(tickColumns({}).size())) {
        table += "| `" + std::string(column.name) + "` | " +
                 (column.of_effects ? namesOfEffectsWith(*column.of_effects) : "any of these") + " | " +
                 column.description + " |\n";
    }
    return table;
}

TEST(TickColumns, EachHasANameOfItsOwnAndItsUnit) {
    std::set<std::string> names;
    for (const TickColumn& column : tickColumns(all())) {
        ASSERT_TRUE(column.name || column.trace_names);
        EXPECT_TRUE(names.insert(column.name ? column.name : column.trace_names).second);
        EXPECT_TRUE(column.unit && column.description) << column.trace_names;
        EXPECT_NE(column.of_tick == nullptr, column.of_effects == nullptr);
    }
}

TEST(TickColumns, ASceneWithoutEffectsHasNoneOfTheirs) {
    for (const TickColumn& column : tickColumns({})) EXPECT_FALSE(column.of_effects);
    EXPECT_LT(tickColumns({}).size(), tickColumns({.heat = true}).size());
}

TEST(EffectFigures, ThoseOfARunHaveKeysOfTheirOwn) {
    std::set<std::string> keys;
    for (const EffectFigure& figure : kEffectFigures) {
        EXPECT_EQ(figure.run.key == nullptr, figure.run.summary == RunSummary::kNone) << figure.name;
        EXPECT_TRUE(!figure.run.key || keys.insert(figure.run.key).second) << figure.run.key;
        EXPECT_TRUE(figure.shown.unit || !(figure.run.words || figure.shown.line)) << figure.name;
    }
}

// BONEMILL_WRITE_DOCS=1 writes the table instead of comparing it.
TEST(TickColumns, DocsHoldTheTableOfEffects) {
    const auto page = std::filesystem::path(test::sourceDir()) / "docs/reference/simulate.md";
    std::ifstream stream(page);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    stream.close();
    const std::string heading = "| column | there with | meaning |\n|---|---|---|\n";
    ASSERT_NE(text.find(heading), std::string::npos) << page;
    const size_t start = text.find(heading) + heading.size(), end = text.find("\n\n", start) + 1;
    const std::string wanted = text.substr(0, start) + tableOfEffects() + text.substr(end);
    if (std::getenv("BONEMILL_WRITE_DOCS")) std::ofstream(page) << wanted;
    std::ifstream again(page);
    const std::string now{std::istreambuf_iterator<char>(again), {}};
    EXPECT_EQ(now, wanted) << "run this test with BONEMILL_WRITE_DOCS=1";
}

}  // namespace
}  // namespace bonemill
