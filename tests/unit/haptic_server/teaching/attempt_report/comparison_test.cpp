#include "haptic_server/teaching/attempt_report/comparison.h"

#include <gtest/gtest.h>

#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"

namespace bonemill {
namespace {

// Forces of 2, 3, 4, 5, 6 N: mean 4, deviation sqrt(2.5).
std::vector<AttemptResult> fiveExperts() {
    std::vector<AttemptResult> experts;
    for (uint32_t n = 0; n < 5; ++n) {
        AttemptResult expert = test::typicalResult("E" + std::to_string(n), n);
        expert.assessment.figures[0].value = 2 + n;
        expert.assessment.series[1].columns[0].values.assign(5, 1.0 + n);
        experts.push_back(expert);
    }
    return experts;
}

TEST(Comparison, TellsHowFarFromTheExpertsEachFigureIs) {
    AttemptResult result = test::typicalResult();
    result.assessment.figures[0].value = 9;
    const auto comparison = compareWith(fiveExperts(), result);
    ASSERT_TRUE(comparison);
    EXPECT_EQ(comparison->experts, 5);
    ASSERT_EQ(comparison->figures.size(), 1) << "the others are the same for all";
    EXPECT_EQ(comparison->figures[0].id, "force.max");
    EXPECT_DOUBLE_EQ(comparison->figures[0].mean, 4);
    EXPECT_NEAR(comparison->figures[0].z, 5 / std::sqrt(2.5), 1e-12);
}

TEST(Comparison, HasTheBandOfTheExperts) {
    const auto comparison = compareWith(fiveExperts(), test::typicalResult());
    ASSERT_EQ(comparison->envelopes.size(), 1);
    EXPECT_NEAR(comparison->envelopes[0].low[2], 3 - 2 * std::sqrt(2.5), 1e-12);
    EXPECT_NEAR(comparison->envelopes[0].high[2], 3 + 2 * std::sqrt(2.5), 1e-12);
}

TEST(Comparison, OfOtherScenesVersionsOrTooFewThereIsNone) {
    auto experts = fiveExperts();
    const AttemptResult result = test::typicalResult();
    experts[1].scene_hash = "1";
    EXPECT_FALSE(compareWith(experts, result));
    experts = fiveExperts();
    experts[1].assessment.figures[0].version = 2;
    const auto comparison = compareWith(experts, result);
    ASSERT_TRUE(comparison);
    EXPECT_TRUE(comparison->figures.empty());
}

}  // namespace
}  // namespace bonemill
