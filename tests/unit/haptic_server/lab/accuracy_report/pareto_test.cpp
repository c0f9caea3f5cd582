#include <gtest/gtest.h>

#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {
namespace {

// The pairs are error and time.
const std::vector<ParetoPoint> kPoints{
    {10, 20},         // 0: fastest
    {5, 30},          // 1
    {6, 40},          // 2: worse than 1 in both
    {1, 90},          // 3
    {1, 100},         // 4: as exact as 3, slower
    {0.5, 200},       // 5: most exact
    {0.1, 10, false}  // 6: no candidate
};

TEST(ParetoFront, HoldsWhatNothingBeats) {
    EXPECT_EQ(paretoFront(kPoints), (std::vector<bool>{true, true, false, true, false, true, false}));
}

TEST(ParetoFront, EqualPointsAreBothOnIt) {
    const std::vector<ParetoPoint> points{{2, 3}, {2, 3}};
    EXPECT_EQ(paretoFront(points), (std::vector<bool>{true, true}));
    EXPECT_TRUE(paretoFront({}).empty());
}

TEST(BudgetProposal, IsTheMostExactThatFits) {
    EXPECT_EQ(bestWithin(kPoints, 95), 3u);
    EXPECT_EQ(bestWithin(kPoints, 90), 3u);  // the budget itself fits
    EXPECT_EQ(bestWithin(kPoints, 89.9), 1u);
    EXPECT_EQ(bestWithin(kPoints, 1000), 5u);
    EXPECT_EQ(bestWithin(kPoints, 20), 0u);
}

TEST(BudgetProposal, NothingFits) {
    EXPECT_FALSE(bestWithin(kPoints, 19.9));  // only the one that is no candidate would
    EXPECT_FALSE(bestWithin({}, 100));
}

TEST(BudgetProposal, PaysNothingForTheSameError) {
    const std::vector<ParetoPoint> points{{1.0, 80}, {1.01, 30}, {1.05, 20}};
    EXPECT_EQ(bestWithin(points, 100), 1u);
    EXPECT_EQ(bestWithin(points, 25), 2u);
}

TEST(NextBetter, IsTheFastestThatIsMoreExact) {
    EXPECT_EQ(nextBetter(kPoints, 0), 1u);
    EXPECT_EQ(nextBetter(kPoints, 2), 1u);
    EXPECT_EQ(nextBetter(kPoints, 1), 3u);
    EXPECT_EQ(nextBetter(kPoints, 4), 5u);
    EXPECT_FALSE(nextBetter(kPoints, 5));
}

TEST(NextBetter, MustBeBetterByMoreThanRounding) {
    const std::vector<ParetoPoint> points{{1.0, 80}, {0.99, 10}, {0.9, 300}};
    EXPECT_EQ(nextBetter(points, 0), 2u);
}

}  // namespace
}  // namespace bonemill
