#include "device_daemon/bridges/ros2_arm/servo_hand.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"

namespace bonemill::bridge {
namespace {

constexpr int64_t kMs = kNsPerMillisecond;
constexpr uint64_t kRobot = 7, kOther = 8;

ros2::PoseStamped at(double x, const char* frame = ros2::kDeviceFrame) {
    return ros2::poseOf(0, frame, {{x, 0, 0}, Eigen::Quaterniond::Identity()});
}

struct Pressed {
    explicit Pressed(std::vector<int32_t> values) : values_(std::move(values)) {
        ros2::pointAt(joy.buttons, values_);
    }
    ros2::Joy joy{};

  private:
    std::vector<int32_t> values_;
};

TEST(ServoHand, IsNotHomedBeforeTheFirstPose) {
    const ServoHand hand;
    const ArmReading reading = hand.reading(1000 * kMs);
    EXPECT_TRUE(reading.is_valid) << "nothing is wrong";
    EXPECT_FALSE(reading.is_homed);
    EXPECT_FALSE(reading.is_powered);
}

TEST(ServoHand, CountsForAsLongAsItIsFresh) {
    ServoHand hand;
    EXPECT_TRUE(hand.take(at(0.1), kRobot, 0));
    EXPECT_EQ(hand.reading(30 * kMs).X_DT.position.x(), 0.1);
    EXPECT_TRUE(hand.reading(30 * kMs).is_valid);
    EXPECT_FALSE(hand.reading(31 * kMs).is_valid);
    EXPECT_TRUE(hand.reading(31 * kMs).is_homed) << "so that it is missed";
    EXPECT_TRUE(hand.take(at(0.2), kRobot, 100 * kMs));
    EXPECT_TRUE(hand.reading(100 * kMs).is_valid);
}

TEST(ServoHand, IsLedByOneNodeUntilThatIsSilent) {
    ServoHand hand;
    hand.take(at(0.1), kRobot, 0);
    EXPECT_FALSE(hand.take(at(0.5), kOther, 20 * kMs));
    EXPECT_EQ(hand.foreignHands(), 1u);
    EXPECT_EQ(hand.reading(20 * kMs).X_DT.position.x(), 0.1);
    EXPECT_TRUE(hand.take(at(0.5), kOther, 31 * kMs));
    EXPECT_FALSE(hand.take(at(0.1), kRobot, 32 * kMs));
}

TEST(ServoHand, KnowsOneFrame) {
    ServoHand hand;
    EXPECT_FALSE(hand.take(at(0.1, "map"), kRobot, 0));
    EXPECT_FALSE(hand.reading(0).is_homed);
    EXPECT_EQ(hand.foreignFrames(), 1u);
    EXPECT_TRUE(hand.take(at(0.1, ""), kRobot, 0));
    EXPECT_TRUE(hand.take(at(0.1, nullptr), kRobot, 0));
}

// The daemon has to hear it to stop for the right cause.
TEST(ServoHand, PassesOnWhatIsNoPose) {
    ServoHand hand;
    EXPECT_TRUE(hand.take(at(std::nan("")), kRobot, 0));
    EXPECT_TRUE(std::isnan(hand.reading(0).X_DT.position.x()));
}

TEST(ServoHand, HoldsButtonsForAMoment) {
    ServoHand hand;
    hand.take(Pressed({1}).joy, 0);
    EXPECT_EQ(hand.reading(500 * kMs).buttons, uint32_t(kButtonRemove));
    EXPECT_EQ(hand.reading(501 * kMs).buttons, 0u);
    EXPECT_TRUE(hand.reading(501 * kMs).is_enabled);
    hand.take(Pressed({0, 1}).joy, 600 * kMs);
    EXPECT_EQ(hand.reading(600 * kMs).buttons, uint32_t(kButtonAdd));
    hand.take(Pressed({}).joy, 700 * kMs);
    EXPECT_EQ(hand.reading(700 * kMs).buttons, 0u);
}

TEST(ServoHand, GivesForceOnlyWhileAThirdButtonIsHeldThatThereWas) {
    ServoHand hand;
    hand.take(Pressed({0, 0, 1}).joy, 0);
    EXPECT_TRUE(hand.reading(0).is_enabled);
    EXPECT_FALSE(hand.reading(501 * kMs).is_enabled) << "its node is silent";
    hand.take(Pressed({0, 0, 0}).joy, 600 * kMs);
    EXPECT_FALSE(hand.reading(600 * kMs).is_enabled);
    hand.take(Pressed({0, 0}).joy, 700 * kMs);
    EXPECT_FALSE(hand.reading(700 * kMs).is_enabled);
    hand.take(Pressed({0, 0, 1}).joy, 800 * kMs);
    EXPECT_TRUE(hand.reading(800 * kMs).is_enabled);
}

}  // namespace
}  // namespace bonemill::bridge
