// A hard case has one figure and its bound, measured for every variant, and some with effects and other
// devices as well. A case holds if figure <= bound.
//
// A variant for which a case is known to fail, deterministically, is not left out: it runs in the suite
// BaselineFails (thesis_2012), OtherLawFails (those of other schools) or KnownLimit (ours), which expects the
// figure beyond the bound, so that the documentation's table stays true. With BONEMILL_STABILITY_LAWS=1 every
// case is measured for every law of another school as well, and judged nowhere: the suite Reported. Each run
// prints its figure and appends it to the CSV file named by BONEMILL_STABILITY_REPORT (case, variant,
// measured, bound, unit, pass); docs/explanation/stability.md is filled from it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/stability/variant.h"

namespace bonemill::test {

// Returns the larger of two figures; a figure that is no number stays.
inline double worseOf(double a, double b) {
    return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

struct StabilityCase {
    std::string name;  // snake_case
    const char* unit;
    double bound;
    double (*measure)(const Variant&);
    Names fails_for;  // names of variants
    Names also_for =
        {};  // names of lawVariants(), effectVariants() and deviceVariants() for which it is measured too
    bool needs_effects = false;  // only for those
};

struct Trial {
    StabilityCase stability_case;
    Variant variant;
};
void PrintTo(const Trial& trial, std::ostream* out);  // GoogleTest's name for it

class StabilityTrial : public testing::TestWithParam<Trial> {
  protected:
    // Measures, prints, appends, and returns the figure.
    double measureAndReport() const;
};
class Holds : public StabilityTrial {};
class BaselineFails : public StabilityTrial {};
class OtherLawFails : public StabilityTrial {};
class KnownLimit : public StabilityTrial {};
class Reported : public StabilityTrial {};

enum class Expectation { kHolds, kBaselineFails, kOtherLawFails, kKnownLimit, kReported };
std::vector<Trial> trials(const std::vector<StabilityCase>& cases, Expectation expectation);
std::string trialName(const testing::TestParamInfo<Trial>& info);

}  // namespace bonemill::test

// Use it in the file of the cases, in namespace bonemill::test.
#define BONEMILL_STABILITY_CASES(group, cases)                                                              \
    INSTANTIATE_TEST_SUITE_P(group, Holds, testing::ValuesIn(trials(cases, Expectation::kHolds)),           \
                             trialName);                                                                    \
    INSTANTIATE_TEST_SUITE_P(group, BaselineFails,                                                          \
                             testing::ValuesIn(trials(cases, Expectation::kBaselineFails)), trialName);     \
    INSTANTIATE_TEST_SUITE_P(group, OtherLawFails,                                                          \
                             testing::ValuesIn(trials(cases, Expectation::kOtherLawFails)), trialName);     \
    INSTANTIATE_TEST_SUITE_P(group, KnownLimit, testing::ValuesIn(trials(cases, Expectation::kKnownLimit)), \
                             trialName);                                                                    \
    INSTANTIATE_TEST_SUITE_P(group, Reported, testing::ValuesIn(trials(cases, Expectation::kReported)),     \
                             trialName)
