#include "device_daemon/ares/emulator/scenario.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

scene::Scene sceneFrom(const std::string& text) {
    scene::Scene scene;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &scene));
    return scene;
}

std::string refusalOf(const std::string& text) {
    try {
        scenarioOf(sceneFrom(text));
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(Scenarios, DefaultsOfTheSceneAreTheDefaultsOfTheCode) {
    const Scenario scenario = scenarioOf(scene::Scene{}), code;
    EXPECT_EQ(scenario.rate_hz, code.rate_hz);
    EXPECT_EQ(scenario.max_actuator_force, code.max_actuator_force);
    EXPECT_EQ(scenario.max_force, code.max_force);
    EXPECT_NEAR(scenario.max_torque, code.max_torque, 1e-15);
    EXPECT_NEAR(scenario.geometry.link_length, code.geometry.link_length, 1e-15);
    EXPECT_NEAR(scenario.geometry.stroke, code.geometry.stroke, 1e-15);
    EXPECT_EQ(scenario.plant.moving_mass, code.plant.moving_mass);
    EXPECT_EQ(scenario.plant.coulomb_friction, code.plant.coulomb_friction);
    EXPECT_EQ(scenario.plant.unbalanced_mass, 0);
    EXPECT_EQ(scenario.plant.play, 0);
    EXPECT_NEAR(scenario.plant.encoder_step, code.plant.encoder_step, 1e-18);
    EXPECT_EQ(scenario.hand.stiffness, code.hand.stiffness);
}

TEST(Scenarios, TakePlayAndUnbalancedMassFromTheScene) {
    const Scenario scenario = scenarioOf(sceneFrom("device { unbalanced_mass_kg: 0.1 play_um: 20 }"));
    EXPECT_EQ(scenario.plant.unbalanced_mass, 0.1);
    EXPECT_NEAR(scenario.plant.play, 20e-6, 1e-15);
}

TEST(Scenarios, MoveWaypointsFromTheWorldToTheDevice) {
    const Scenario scenario = scenarioOf(sceneFrom(R"(
        device { p_WD_mm { x: 100 y: 200 z: 300 } q_WD { w: 0.70710678118654752 z: 0.70710678118654752 } }
        simulated_operator {
          waypoint { time_s: 0 p_WT_mm { x: 100 y: 210 z: 300 } q_WT { w: 0.70710678118654752 z: 0.70710678118654752 }
                     remove: true phase: "mill" }
          waypoint { time_s: 1 p_WT_mm { x: 100 y: 210 z: 295 } q_WT { w: 0.70710678118654752 z: 0.70710678118654752 }
                     add: true } })"));
    const HandTarget start = scenario.path.at(0);
    // D's x axis is W's y axis.
    EXPECT_LT((start.X_DT.position - Eigen::Vector3d(0.010, 0, 0)).norm(), 1e-12);
    EXPECT_LT(logRotation(start.X_DT.rotation).norm(), 1e-12);
    EXPECT_EQ(start.buttons, 1u);
    EXPECT_EQ(scenario.path.at(1).buttons, 2u);
    EXPECT_EQ(phaseOf(scenario, 1), "mill");
    EXPECT_EQ(phaseOf(scenario, -1), "hold");
}

TEST(Scenarios, RefuseWhatTheDeviceCannotDo) {
    const std::string message = refusalOf(R"(simulated_operator {
        waypoint { time_s: 0 } waypoint { time_s: 2 p_WT_mm { z: 80 } } })");
    EXPECT_NE(message.find("waypoint[1]"), std::string::npos) << message;
    EXPECT_NE(message.find("stroke"), std::string::npos) << message;
    EXPECT_NE(refusalOf("device { link_length_mm: 50 }").find("link_length_mm"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
