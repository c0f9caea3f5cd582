#include "device_daemon/app/device_setup.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/user_error.h"

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

TEST(DeviceSetup, DefaultsOfTheSceneAreTheDefaultsOfTheCode) {
    const DeviceSetup setup = deviceSetupOf(scene::Scene{});
    const AresGeometry geometry;
    EXPECT_NEAR(setup.geometry.base_radius, geometry.base_radius, 1e-15);
    EXPECT_NEAR(setup.geometry.platform_radius, geometry.platform_radius, 1e-15);
    EXPECT_NEAR(setup.geometry.base_half_angle, geometry.base_half_angle, 1e-15);
    EXPECT_NEAR(setup.geometry.platform_half_angle, geometry.platform_half_angle, 1e-15);
    EXPECT_NEAR(setup.geometry.link_length, geometry.link_length, 1e-15);
    EXPECT_NEAR(setup.geometry.stroke, geometry.stroke, 1e-15);
    const AresPlant plant;
    EXPECT_EQ(setup.plant.moving_mass, plant.moving_mass);
    EXPECT_EQ(setup.plant.moving_inertia, plant.moving_inertia);
    EXPECT_EQ(setup.plant.viscous_friction, plant.viscous_friction);
    EXPECT_EQ(setup.plant.angular_friction, plant.angular_friction);
    EXPECT_EQ(setup.plant.coulomb_friction, plant.coulomb_friction);
    EXPECT_EQ(setup.plant.amplifier_bandwidth_hz, plant.amplifier_bandwidth_hz);
    EXPECT_NEAR(setup.plant.encoder_step, plant.encoder_step, 1e-18);
    const HandImpedance hand;
    EXPECT_EQ(setup.hand.mass, hand.mass);
    EXPECT_EQ(setup.hand.damping, hand.damping);
    EXPECT_EQ(setup.hand.stiffness, hand.stiffness);
    EXPECT_EQ(setup.hand.inertia, hand.inertia);
    EXPECT_EQ(setup.hand.angular_damping, hand.angular_damping);
    EXPECT_EQ(setup.hand.angular_stiffness, hand.angular_stiffness);
    EXPECT_EQ(setup.loop.limits.max_actuator_force, ForceLimits{}.max_actuator_force);
    EXPECT_EQ(setup.loop.stale.stale_after_ns, StaleRampConfig{}.stale_after_ns);
    EXPECT_EQ(setup.loop.stale.ramp_down_ns, StaleRampConfig{}.ramp_down_ns);
    EXPECT_EQ(setup.rate_hz, 1000);
}

TEST(DeviceSetup, MovesWaypointsFromTheWorldToTheDevice) {
    const DeviceSetup setup = deviceSetupOf(sceneOf(R"(
        device { p_WD_mm { x: 100 y: 200 z: 300 } q_WD { w: 0.70710678118654752 z: 0.70710678118654752 } }
        simulated_operator {
          waypoint { time_s: 0 p_WT_mm { x: 100 y: 210 z: 300 } q_WT { w: 0.70710678118654752 z: 0.70710678118654752 }
                     remove: true phase: "mill" }
          waypoint { time_s: 1 p_WT_mm { x: 100 y: 210 z: 295 } q_WT { w: 0.70710678118654752 z: 0.70710678118654752 }
                     add: true } })"));
    const HandTarget start = setup.path.at(0);
    // D's x axis is W's y axis.
    EXPECT_LT((start.X_DT.position - Eigen::Vector3d(0.010, 0, 0)).norm(), 1e-12);
    EXPECT_LT(logRotation(start.X_DT.rotation).norm(), 1e-12);
    EXPECT_EQ(start.buttons, 1u);
    EXPECT_EQ(setup.path.at(1).buttons, 2u);
    EXPECT_LT(((setup.X_WD * setup.path.at(1).X_DT).position - Eigen::Vector3d(0.1, 0.21, 0.295)).norm(),
              1e-12);
    EXPECT_EQ(setup.phases, (std::vector<std::string>{"mill", "mill"}));
}

TEST(DeviceSetup, RefusesAPathOutsideTheWorkspace) {
    const std::string message = refusalOf(R"(simulated_operator {
        waypoint { time_s: 0 } waypoint { time_s: 2 p_WT_mm { z: 80 } } })");
    EXPECT_NE(message.find("waypoint[1]"), std::string::npos) << message;
    EXPECT_NE(message.find("stroke"), std::string::npos) << message;
    EXPECT_NE(message.find("device.p_WD_mm"), std::string::npos) << message;
}

TEST(DeviceSetup, RefusesAGeometryThatCannotBeBuilt) {
    EXPECT_NE(refusalOf("device { link_length_mm: 50 }").find("link_length_mm"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
