#include "common/ros/ros_messages.h"

#include <gtest/gtest.h>

namespace bonemill::ros2 {
namespace {

TEST(RosMessages, HaveSecondsAndNanosecondsAndTheirOrderOfQuaternions) {
    const Pose X_FT{{1, 2, 3}, {0.1, 0.2, 0.3, 0.4}};
    const PoseStamped message = poseOf(1'700'000'000'123'456'789, kWorldFrame, X_FT);
    EXPECT_EQ(message.header.stamp.sec, 1'700'000'000);
    EXPECT_EQ(message.header.stamp.nanosec, 123'456'789u);
    EXPECT_STREQ(message.header.frame_id, "bonemill_world");
    EXPECT_EQ(message.pose.position.y, 2);
    EXPECT_EQ(message.pose.orientation.w, 0.1);
    EXPECT_EQ(message.pose.orientation.x, 0.2);
    EXPECT_EQ(message.pose.orientation.z, 0.4);
    const Pose back = poseOf(message);
    EXPECT_EQ(back.position, X_FT.position);
    EXPECT_EQ(back.rotation.coeffs(), X_FT.rotation.coeffs());
}

TEST(RosMessages, SayWrenchAndTwistInTheirOrder) {
    const WrenchStamped wrench = wrenchOf(0, kDeviceFrame, {{1, 2, 3}, {4, 5, 6}});
    EXPECT_EQ(wrench.wrench.force.z, 3);
    EXPECT_EQ(wrench.wrench.torque.x, 4);
    const TwistStamped twist = twistOf(0, kWorldFrame, {1, 2, 3}, {4, 5, 6});
    EXPECT_EQ(twist.twist.linear.x, 1);
    EXPECT_EQ(twist.twist.angular.z, 6);
}

}  // namespace
}  // namespace bonemill::ros2
