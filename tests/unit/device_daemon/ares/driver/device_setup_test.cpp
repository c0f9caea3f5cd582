#include "device_daemon/device_setup/device_setup.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

scene::Scene sceneOf(const std::string& text) {
    scene::Scene scene;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &scene));
    return scene;
}

std::string refusalOf(const std::string& text) {
    try {
        deviceSetupOf(sceneOf(text));
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

// From the patient's left, with the device turned as much: right in the picture is the device's x.
TEST(DeviceSetup, ASpaceMousesAxesAreThoseOfTheFirstPicture) {
    const DeviceSetup setup = deviceSetupOf(sceneOf(
        "camera { azimuth_deg: 90 elevation_deg: 0 } device { q_WD { w: 0.70710678 z: 0.70710678 } }"));
    EXPECT_TRUE((setup.rates.R_DU * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitX(), 1e-6));
    EXPECT_TRUE((setup.rates.R_DU * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-6));
}

TEST(DeviceSetup, DefaultsOfTheSceneAreTheDefaultsOfTheCode) {
    const DeviceSetup setup = deviceSetupOf(scene::Scene{});
    const DeviceLoopConfig loop;
    EXPECT_EQ(setup.rate_hz, 1000);
    EXPECT_EQ(setup.hand_space.wayAtTool(1.0), 1);
    EXPECT_EQ(setup.loop.wrench.max_force, loop.wrench.max_force);
    EXPECT_EQ(setup.loop.wrench.max_torque, loop.wrench.max_torque);
    EXPECT_EQ(setup.loop.wrench.max_force_rate, loop.wrench.max_force_rate);
    EXPECT_EQ(setup.loop.wrench.max_torque_rate, loop.wrench.max_torque_rate);
    EXPECT_EQ(setup.loop.motion.max_speed, loop.motion.max_speed);
    EXPECT_NEAR(setup.loop.motion.max_angular_speed, loop.motion.max_angular_speed, 0.1);
    EXPECT_EQ(setup.loop.motion.max_power, loop.motion.max_power);
    EXPECT_EQ(setup.loop.motion.max_energy, loop.motion.max_energy);
    EXPECT_EQ(setup.loop.states.engage_force, loop.states.engage_force);
    EXPECT_EQ(setup.loop.states.engage_torque, loop.states.engage_torque);
    EXPECT_EQ(setup.loop.states.engage_time, loop.states.engage_time);
    EXPECT_EQ(setup.loop.states.ramp_time, loop.states.ramp_time);
    EXPECT_EQ(setup.loop.states.silence, loop.states.silence);
}

TEST(DeviceSetup, TheHandBeginsAtTheFirstWaypoint) {
    const DeviceSetup setup = deviceSetupOf(sceneOf(R"(
        device { workspace_scale: 2 p_WD_mm { x: 100 y: 200 z: 300 }
                 q_WD { w: 0.70710678118654752 z: 0.70710678118654752 } }
        simulated_operator {
          waypoint { p_WT_mm { x: 100 y: 210 z: 300 } q_WT { w: 0.70710678118654752 z: 0.70710678118654752 } } })"));
    // D's x axis is W's y axis, and the handle moves half as far as the tool.
    EXPECT_LT((setup.X_DT_start.position - Eigen::Vector3d(0.005, 0, 0)).norm(), 1e-12);
    EXPECT_LT(logRotation(setup.X_DT_start.rotation).norm(), 1e-12);
}

TEST(DeviceSetup, RefusesAGeometryThatCannotBeBuilt) {
    EXPECT_NE(refusalOf("device { link_length_mm: 50 }").find("link_length_mm"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
