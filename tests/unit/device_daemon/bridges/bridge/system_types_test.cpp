#include <gtest/gtest.h>

#include "device_daemon/bridges/force_dimension/force_dimension_arm.h"

namespace bonemill::bridge {
namespace {

TEST(SystemTypes, KnownArmsHaveTheirLimits) {
    EXPECT_EQ(systemTypeOf(63).max_force, 20);
    EXPECT_EQ(systemTypeOf(34).max_torque, 0) << "an omega.6 senses rotation only";
    EXPECT_EQ(systemTypeOf(104).max_torque, 0.2);
    EXPECT_EQ(systemTypeOf(60).workspace_radius, 0.04);
}

TEST(SystemTypes, AnUnknownArmIsTakenForTheWeakest) {
    const SystemType unknown = systemTypeOf(999);
    for (const int type : {63, 33, 34, 35, 36, 37, 206, 104, 105, 203, 131, 132, 108, 109, 60})
        EXPECT_LE(unknown.max_force, systemTypeOf(type).max_force);
    EXPECT_EQ(unknown.max_torque, 0);
}

}  // namespace
}  // namespace bonemill::bridge
