#include <gtest/gtest.h>

#include "haptic_server/core/tick/tick_budget.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

constexpr int kSecond = 1000;  // ticks

// Makes the choice tick by tick; each choice is in force at once.
class Chooser {
  public:
    // Returns the factor after `ticks` more with this load.
    int after(int ticks, double budget_share, bool has_overflow = false, int asked_for = 1) {
        SpoStep step;
        step.budget_share = budget_share;
        step.has_contact_overflow = has_overflow;
        for (int n = 0; n < ticks; ++n) in_force_ = affordable_.factor(shell_, asked_for, in_force_, step);
        return in_force_;
    }

  private:
    VoxelVolume volume_ = test::bodyVolume(test::cubeGeometry(16, 1e-3),
                                           test::halfSpace({0, 0, 8e-3}, Eigen::Vector3d::UnitZ()));
    LeafLattice lattice_{volume_, Eigen::Vector3i::Constant(16)};
    PointShell shell_{volume_, lattice_, {.levels = {{1}, {3}, {2}}}};
    AffordableShell affordable_{1.0 / kSecond};
    int in_force_ = 1;
};

TEST(AffordableShell, KeepsWhatIsAskedForAsLongAsThereIsTime) {
    Chooser chooser;
    EXPECT_EQ(chooser.after(1, 0.99), 1);
    EXPECT_EQ(chooser.after(1, 0.1, false, 3), 3);
    EXPECT_EQ(chooser.after(1, 0.1, false, 1), 1);
}

TEST(AffordableShell, GoesALevelCoarserWithEveryOverflowUpToTheCoarsest) {
    Chooser chooser;
    EXPECT_EQ(chooser.after(1, 1, true), 2);
    EXPECT_EQ(chooser.after(1, 1, true), 3);
    EXPECT_EQ(chooser.after(5, 1, true), 3);
}

TEST(AffordableShell, ComesBackALevelASecondWhenTheFinerOneIsAffordableTwiceOver) {
    Chooser chooser;
    ASSERT_EQ(chooser.after(2, 1, true), 3);
    // From 3 to 2 the points grow to 9/4: a share of 0.2 becomes 0.45.
    EXPECT_EQ(chooser.after(kSecond, 0.2), 3);
    EXPECT_EQ(chooser.after(1, 0.2), 2);
    EXPECT_EQ(chooser.after(kSecond, 0.12), 2);
    EXPECT_EQ(chooser.after(1, 0.12), 1);
}

TEST(AffordableShell, StaysCoarseWhileTheFinerOneWouldTakeHalfOfTheTime) {
    Chooser chooser;
    ASSERT_EQ(chooser.after(1, 1, true), 2);
    EXPECT_EQ(chooser.after(10 * kSecond, 0.13), 2);  // 0.52 at factor 1
}

TEST(AffordableShell, ABusyTickBeginsTheSecondAnew) {
    Chooser chooser;
    ASSERT_EQ(chooser.after(1, 1, true), 2);
    EXPECT_EQ(chooser.after(kSecond - 1, 0.1), 2);
    EXPECT_EQ(chooser.after(1, 0.9), 2);
    EXPECT_EQ(chooser.after(kSecond, 0.1), 2);
    EXPECT_EQ(chooser.after(1, 0.1), 1);
}

TEST(AffordableShell, WhoAsksForACoarserOneGetsIt) {
    Chooser chooser;
    ASSERT_EQ(chooser.after(1, 1, true), 2);
    EXPECT_EQ(chooser.after(1, 0.1, false, 3), 3);
    EXPECT_EQ(chooser.after(1, 0.1, false, 1), 1);  // what was asked for was coarser than what had to be
}

}  // namespace
}  // namespace bonemill
