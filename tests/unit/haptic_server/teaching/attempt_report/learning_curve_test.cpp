#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "haptic_server/teaching/attempt_report/comparison.h"

namespace bonemill {
namespace {

std::vector<double> curveOf(double first, double limit, double rate, size_t attempts) {
    std::vector<double> values;
    for (size_t n = 1; n <= attempts; ++n)
        values.push_back(limit + (first - limit) * std::pow(double(n), -rate));
    return values;
}

TEST(LearningCurve, OfACurveItFindsWhatItWasMadeOf) {
    for (const double rate : {0.2, 0.7, 1.5}) {
        const auto curve = fitLearningCurve(curveOf(300, 100, rate, 12));
        ASSERT_TRUE(curve);
        EXPECT_NEAR(curve->rate, rate, 1e-4);
        EXPECT_NEAR(curve->first, 300, 0.01);
        EXPECT_NEAR(curve->limit, 100, 0.1);
        EXPECT_NEAR(curve->deviation, 0, 1e-4);
    }
}

TEST(LearningCurve, ItMayRise) {
    const auto curve = fitLearningCurve(curveOf(0.2, 0.9, 1, 8));
    ASSERT_TRUE(curve);
    EXPECT_NEAR(curve->limit, 0.9, 1e-3);
    EXPECT_NEAR(curve->at(8), 0.9 - 0.7 / 8, 1e-4);
}

TEST(LearningCurve, FiveAttemptsMakeNone) {
    EXPECT_FALSE(fitLearningCurve(curveOf(300, 100, 0.7, 5)));
    EXPECT_TRUE(fitLearningCurve(curveOf(300, 100, 0.7, 6)));
    EXPECT_FALSE(fitLearningCurve(std::vector<double>(8, 3.0)));
    EXPECT_FALSE(fitLearningCurve(std::vector<double>{1, 2, 3, 4, std::nan(""), 6}));
}

}  // namespace
}  // namespace bonemill
