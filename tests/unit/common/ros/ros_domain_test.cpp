#include "common/ros/ros_domain.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "common/base/user_error.h"

namespace bonemill::ros2 {
namespace {

TEST(RosNamespace, IsPartsOfLettersDigitsAndUnderscores) {
    EXPECT_EQ(requireNamespace("bonemill"), "bonemill");
    EXPECT_EQ(requireNamespace("/lab/drill_2"), "lab/drill_2");
    for (const char* const name : {"", "/", "a/", "//a", "a//b", "2a", "a/2b", "a-b", "a b", "a\n"})
        EXPECT_THROW(requireNamespace(name), UserError) << name;
    EXPECT_THROW(requireNamespace(std::string(101, 'a')), UserError);
}

TEST(RosOptions, TakeTheDomainOfTheEnvironment) {
    unsetenv("ROS_DOMAIN_ID");
    EXPECT_EQ(rosOptionsOfEnvironment().domain, 0u);
    setenv("ROS_DOMAIN_ID", "42", 1);
    EXPECT_EQ(rosOptionsOfEnvironment().domain, 42u);
    for (const char* const text : {"4x", "-1", " 3", "99999999999"}) {
        setenv("ROS_DOMAIN_ID", text, 1);
        EXPECT_THROW(rosOptionsOfEnvironment(), UserError) << text;
    }
    unsetenv("ROS_DOMAIN_ID");
}

TEST(RosOptions, StayOnThisPcWhereRosDoes) {
    unsetenv("ROS_LOCALHOST_ONLY"), unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
    EXPECT_FALSE(isLocalhostOnly());
    setenv("ROS_LOCALHOST_ONLY", "1", 1);
    EXPECT_TRUE(isLocalhostOnly());
    setenv("ROS_LOCALHOST_ONLY", "0", 1);
    EXPECT_FALSE(isLocalhostOnly());
    for (const char* const range : {"LOCALHOST", "OFF"}) {
        setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range, 1);
        EXPECT_TRUE(isLocalhostOnly()) << range;
    }
    setenv("CYCLONEDDS_URI", "file:///etc/cyclonedds.xml", 1);
    EXPECT_FALSE(isLocalhostOnly()) << "it says otherwise, perhaps";
    unsetenv("CYCLONEDDS_URI");
    setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET", 1);
    EXPECT_FALSE(isLocalhostOnly());
    unsetenv("ROS_LOCALHOST_ONLY"), unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
}

}  // namespace
}  // namespace bonemill::ros2
