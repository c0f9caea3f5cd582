#include <gtest/gtest.h>

#include "haptic_server/assessment/measures/technique.h"

namespace bonemill {
namespace {

TEST(StepTable, HasARowPerStep) {
    StepTable table(1);
    for (int n = 0; n < 100; ++n) table.add(0.1 * n + 0.05, {.time = 0.1, .max_force = double(n)});
    ASSERT_EQ(table.rows().size(), 10);
    EXPECT_NEAR(table.rows()[3].time, 1, 1e-12);
    EXPECT_EQ(table.rows()[3].max_force, 39);
}

// An hour in seconds, and a day: rows become wider, and nothing is lost.
TEST(StepTable, ALongAttemptGetsWiderSteps) {
    StepTable table(1);
    constexpr int kSeconds = 24 * 3600;
    for (int n = 0; n < kSeconds; ++n) table.add(n, {.time = 1, .removed = 2, .distance = double(n)});
    EXPECT_LE(table.rows().size(), StepTable::kMaxRows);
    EXPECT_GT(table.rows().size(), StepTable::kMaxRows / 2);
    EXPECT_EQ(table.step(), 64);
    double time = 0, removed = 0;
    for (size_t row = 0; row < table.rows().size(); ++row) {
        time += table.rows()[row].time, removed += table.rows()[row].removed;
        EXPECT_EQ(table.rows()[row].distance, double(row) * table.step());
    }
    EXPECT_EQ(time, kSeconds);
    EXPECT_EQ(removed, 2.0 * kSeconds);
}

TEST(StepTable, AStepMayBeJumpedOver) {
    StepTable table(1e-12);
    table.add(0.5e-12, {.time = 1});
    table.add(7.5, {.time = 1});  // very much at once
    table.add(0, {.time = 1});    // belongs to the newest
    EXPECT_LE(table.rows().size(), StepTable::kMaxRows);
    EXPECT_EQ(table.rows().front().time, 1);
    EXPECT_EQ(table.rows().back().time, 2);
}

}  // namespace
}  // namespace bonemill
