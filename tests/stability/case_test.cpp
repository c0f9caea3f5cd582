#include "tests/stability/case_test.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace bonemill::test {
namespace {

bool isAmong(const Names& names, const Variant& variant) {
    return std::find(names.begin(), names.end(), variant.name) != names.end();
}

std::vector<Variant> variantsOf(const StabilityCase& stability_case) {
    std::vector<Variant> variants;
    if (!stability_case.needs_effects) variants = allVariants();
    for (const auto* others : {&lawVariants(), &effectVariants(), &deviceVariants()})
        for (const Variant& variant : *others)
            if (isAmong(stability_case.also_for, variant)) variants.push_back(variant);
    return variants;
}

Expectation expectationOf(const StabilityCase& stability_case, const Variant& variant) {
    if (!isAmong(stability_case.fails_for, variant)) return Expectation::kHolds;
    if (variant.isOtherLaw()) return Expectation::kOtherLawFails;
    return variant.name == baselineVariant().name ? Expectation::kBaselineFails : Expectation::kKnownLimit;
}

// Where the report goes; null: none is wanted.
const char* reportPath() {
    return std::getenv("BONEMILL_STABILITY_REPORT");
}

void appendToReport(const std::string& line) {
    if (!reportPath()) return;
    std::ofstream file(reportPath(), std::ios::app);
    file << line + "\n" << std::flush;  // one write per line: tests may run side by side
    EXPECT_TRUE(file.good()) << reportPath() << " cannot be written";
}

// NaN is beyond every bound.
bool isWithin(double figure, double bound) {
    return figure <= bound;
}

}  // namespace

void PrintTo(const Trial& trial, std::ostream* out) {
    *out << trial.stability_case.name << " " << trial.variant.name;
}

double StabilityTrial::measureAndReport() const {
    const auto& [c, variant] = GetParam();
    const double figure = c.measure(variant);
    const bool pass = isWithin(figure, c.bound);
    std::printf("%-34s %-16s %12.5g %s bound %.5g %s  %s\n", c.name.c_str(), variant.name.c_str(), figure,
                pass ? "<=" : "> ", c.bound, c.unit, pass ? "holds" : "FAILS");
    char line[256];
    std::snprintf(line, sizeof line, "%s,%s,%.6g,%.6g,%s,%d", c.name.c_str(), variant.name.c_str(), figure,
                  c.bound, c.unit, int(pass));
    appendToReport(line);
    return figure;
}

std::vector<Trial> trials(const std::vector<StabilityCase>& cases, Expectation expectation) {
    std::vector<Trial> result;
    if (expectation == Expectation::kReported) {
        if (!std::getenv("BONEMILL_STABILITY_LAWS")) return result;
        for (const StabilityCase& c : cases)
            for (const Variant& variant : lawVariants())
                if (!c.needs_effects) result.push_back({c, variant});
        return result;
    }
    for (const StabilityCase& c : cases)
        for (const Variant& variant : variantsOf(c))
            if (expectationOf(c, variant) == expectation) result.push_back({c, variant});
    return result;
}

std::string trialName(const testing::TestParamInfo<Trial>& info) {
    return info.param.stability_case.name + "_" + info.param.variant.name;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(BaselineFails);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(KnownLimit);

TEST_P(Holds, Figure) {
    EXPECT_PRED2(isWithin, measureAndReport(), GetParam().stability_case.bound);
}
TEST_P(BaselineFails, Figure) {
    const double figure = measureAndReport();
    EXPECT_FALSE(std::isnan(figure));
    EXPECT_FALSE(isWithin(figure, GetParam().stability_case.bound));
}
TEST_P(OtherLawFails, Figure) {
    EXPECT_FALSE(isWithin(measureAndReport(), GetParam().stability_case.bound));
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Reported);  // without a report to write
TEST_P(Reported, Figure) {
    ASSERT_TRUE(reportPath()) << "name the report: BONEMILL_STABILITY_REPORT=FILE";
    measureAndReport();
}
// A limit that is known must not get worse: no more than three in ten settings buzz, no figure is twice
// its bound.
TEST_P(KnownLimit, Figure) {
    const double figure = measureAndReport();
    EXPECT_FALSE(isWithin(figure, GetParam().stability_case.bound));
    const StabilityCase& c = GetParam().stability_case;
    EXPECT_LE(figure, std::string(c.unit) == "percent_buzzing" ? 30 : 2 * c.bound);
}

}  // namespace bonemill::test
