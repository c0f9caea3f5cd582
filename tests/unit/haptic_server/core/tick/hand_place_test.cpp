// False samples do nothing, a hand that is taken elsewhere is believed when it could have got there.
#include <gtest/gtest.h>

#include "haptic_server/core/tick/hand_pose.h"

namespace bonemill {
namespace {

constexpr double kPlaceDt = 1e-3;
const Eigen::Vector3d kBoneMiddle(0.05, 0.05, 0.05);

Pose placeAt(double x) {
    return {kBoneMiddle + Eigen::Vector3d(x, 0, 0), Eigen::Quaterniond::Identity()};
}
Pose placeTurned(double angle) {
    return {kBoneMiddle, expRotation({0, angle, 0})};
}

// Returns after how many ticks the sample is believed that comes in every one.
int ticksUntilBelieved(HandPlace& place, const Pose& sample, int most = 1000) {
    for (int n = 1; n <= most; ++n)
        if (place.take(sample, 1)) return n;
    return most + 1;
}

TEST(HandPlace, AQuickHandIsFollowedAndDoesNotJump) {
    HandPlace place(kBoneMiddle, {}, kPlaceDt);
    EXPECT_TRUE(place.isLost());
    EXPECT_TRUE(place.take(placeAt(0), 1));
    EXPECT_TRUE(place.hasJumped());
    EXPECT_FALSE(place.isLost());
    for (int n = 1; n < 100; ++n) {
        EXPECT_TRUE(place.take(placeAt(2e-3 * n), 1)) << n;
        EXPECT_FALSE(place.hasJumped());
    }
}

TEST(HandPlace, ASampleIsBelievedWhenAHandCouldHaveGotThere) {
    HandPlace place(kBoneMiddle, {}, kPlaceDt);
    place.take(placeAt(0), 1);
    EXPECT_EQ(ticksUntilBelieved(place, placeAt(0.031)), 11);  // 3 m/s
    EXPECT_TRUE(place.hasJumped());
    HandPlace turning(kBoneMiddle, {}, kPlaceDt);
    turning.take(placeTurned(0), 1);
    EXPECT_EQ(ticksUntilBelieved(turning, placeTurned(0.5)), 9);  // 60 rad/s
    // Where the tool goes three times as far as the hand, so may a sample.
    HandPlace scaled(kBoneMiddle, HandSpace(3), kPlaceDt);
    scaled.take(placeAt(0), 1);
    EXPECT_EQ(ticksUntilBelieved(scaled, placeAt(0.031)), 4);
    // A tick that was late says no less of the hand.
    HandPlace late(kBoneMiddle, {}, kPlaceDt);
    late.take(placeAt(0), 1);
    EXPECT_TRUE(late.take(placeAt(0.031), 11));
    EXPECT_FALSE(late.hasJumped());
}

TEST(HandPlace, ALateDeviceMakesNoHandImplausible) {
    HandPlace place(kBoneMiddle, {}, kPlaceDt);
    EXPECT_FALSE(place.repeat(1));
    place.take(placeAt(0), 1);
    for (int n = 0; n < 11; ++n) {
        EXPECT_TRUE(place.repeat(1));
        EXPECT_FALSE(place.hasJumped());
    }
    EXPECT_TRUE(place.take(placeAt(0.035), 1));  // 12 ms on the way
    EXPECT_FALSE(place.hasJumped());
    // A false sample is not believed because nothing comes after it.
    EXPECT_FALSE(place.take(placeAt(0.5), 1));
    for (int n = 0; n < 500; ++n) EXPECT_FALSE(place.repeat(1)) << n;
    EXPECT_TRUE(place.isLost());
    EXPECT_TRUE(place.take(placeAt(0.5), 1));
    EXPECT_TRUE(place.hasJumped());
}

TEST(HandPlace, NothingOutsideOfAnyWorkspaceIsEverBelieved) {
    HandPlace place(kBoneMiddle, {}, kPlaceDt);
    EXPECT_GT(ticksUntilBelieved(place, placeAt(11)), 1000);
    EXPECT_TRUE(place.isLost());
    EXPECT_TRUE(place.take(placeAt(0), 1));
    EXPECT_GT(ticksUntilBelieved(place, placeAt(-900), 100'000), 100'000);
    EXPECT_TRUE(place.take(placeAt(0), 1));
    EXPECT_TRUE(place.hasJumped());
}

TEST(HandPlace, AHandThatNobodyHeardOfForSomeTicksIsLost) {
    HandPlace place(kBoneMiddle, {}, kPlaceDt);
    place.take(placeAt(0), 1);
    const int ticks = int(HandPlace::kLostAfter / kPlaceDt) - 1;
    for (int n = 0; n < ticks; ++n) {
        place.refuse(1);
        EXPECT_FALSE(place.isLost()) << n;
    }
    for (int n = 0; n < 2; ++n) place.refuse(1);
    EXPECT_TRUE(place.isLost());
    EXPECT_TRUE(place.take(placeAt(0.001), 1));
    EXPECT_FALSE(place.isLost());
}

}  // namespace
}  // namespace bonemill
