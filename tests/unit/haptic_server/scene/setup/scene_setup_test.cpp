// A scene that says nothing asks for what the code has by itself.
#include "haptic_server/scene/setup/scene_setup.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

TriangleSurface surfaceOfLength(float length) {
    TriangleSurface surface;
    surface.positions = {{0, -0.001f, 0}, {0.001f, length, 0}};
    return surface;
}

TEST(HandpieceOfATool, SuitsItsLengthUnlessTheSceneChooses) {
    scene::Tool tool;
    EXPECT_EQ(handpieceOf(tool, surfaceOfLength(0.016f)), scene::Tool::CONTRA_ANGLE);
    EXPECT_EQ(handpieceOf(tool, surfaceOfLength(0.055f)), scene::Tool::STRAIGHT);
    tool.set_handpiece(scene::Tool::DRILL_GUIDE);
    EXPECT_EQ(handpieceOf(tool, surfaceOfLength(0.016f)), scene::Tool::DRILL_GUIDE);
    tool.set_handpiece(scene::Tool::NONE);
    EXPECT_EQ(handpieceOf(tool, surfaceOfLength(0.055f)), scene::Tool::NONE);
    tool.clear_handpiece();
    tool.set_mesh_path("whole_tool.stl");
    EXPECT_EQ(handpieceOf(tool, surfaceOfLength(0.055f)), scene::Tool::NONE) << "a mesh is the whole tool";
}

// What the budgets allow follows from the rate (tests/unit/haptic_server/core/tick/tick_budget_test.cpp).
TEST(TickConfigOfAScene, DefaultsOfTheSceneAreTheDefaultsOfTheCode) {
    const TickConfig scene = tickConfigOf(scene::Scene{});
    const TickConfig code;
    EXPECT_DOUBLE_EQ(scene.dt, code.dt);
    EXPECT_DOUBLE_EQ(scene.contact.point_stiffness, code.contact.point_stiffness);
    EXPECT_EQ(scene.contact.full_stiffness_contacts, code.contact.full_stiffness_contacts);
    EXPECT_EQ(scene.contact.shell_level, code.contact.shell_level);
    EXPECT_DOUBLE_EQ(scene.coupling.translation_stiffness, code.coupling.translation_stiffness);
    EXPECT_DOUBLE_EQ(scene.coupling.rotation_stiffness, code.coupling.rotation_stiffness);
    EXPECT_DOUBLE_EQ(scene.coupling.max_speed, code.coupling.max_speed);
    EXPECT_DOUBLE_EQ(scene.coupling.max_angular_speed, code.coupling.max_angular_speed);
    EXPECT_DOUBLE_EQ(scene.coupling.static_damping, code.coupling.static_damping);
    EXPECT_DOUBLE_EQ(scene.hand.max_force, code.hand.max_force);
    EXPECT_DOUBLE_EQ(scene.hand.max_torque, code.hand.max_torque);
    EXPECT_TRUE(effectNames(scene.effects).empty());
}

TEST(TickConfigOfAScene, DefaultsOfTheGradientLawAreTheDefaultsOfTheCode) {
    const GradientConfig scene = tickConfigOf(scene::Scene{}).gradient;
    const GradientConfig code;
    EXPECT_DOUBLE_EQ(scene.contact.stiffness_per_area, code.contact.stiffness_per_area);
    EXPECT_DOUBLE_EQ(scene.contact.stiffness_cap, code.contact.stiffness_cap);
    EXPECT_DOUBLE_EQ(scene.coupling.translation_stiffness, code.coupling.translation_stiffness);
    EXPECT_DOUBLE_EQ(scene.coupling.rotation_stiffness, code.coupling.rotation_stiffness);
    EXPECT_DOUBLE_EQ(scene.coupling.saturation_torque, code.coupling.saturation_torque);
    EXPECT_DOUBLE_EQ(scene.coupling.damping_time, code.coupling.damping_time);
    EXPECT_DOUBLE_EQ(scene.coupling.relaxing_share, code.coupling.relaxing_share);
    EXPECT_DOUBLE_EQ(scene.coupling.relaxing_time, code.coupling.relaxing_time);
    EXPECT_EQ(scene.coupling.p_TG, code.coupling.p_TG);
    EXPECT_DOUBLE_EQ(scene.max_speed, code.max_speed);
    EXPECT_DOUBLE_EQ(scene.max_angular_speed, code.max_angular_speed);
    EXPECT_TRUE(accuracyOf(scene::Scene{}) == AccuracySettings{});
}

// The tool's world is so much larger than the hand's: the hand feels what the scene says.
TEST(TickConfigOfAScene, AScaledWorkspaceLeavesTheStiffnessInTheHand) {
    for (const double scale : {0.3, 3.0}) {
        scene::Scene scene;
        scene.mutable_device()->set_workspace_scale(scale);
        const TickConfig scaled = tickConfigOf(scene), plain;
        EXPECT_EQ(scaled.hand_space.wayAtTool(1.0), scale);
        EXPECT_DOUBLE_EQ(scaled.coupling.translation_stiffness * scale, plain.coupling.translation_stiffness);
        EXPECT_DOUBLE_EQ(scaled.coupling.rotation_stiffness / scale, plain.coupling.rotation_stiffness);
        const EnergyCouplingConfig &at_tool = scaled.gradient.coupling, &in_hand = plain.gradient.coupling;
        EXPECT_DOUBLE_EQ(at_tool.translation_stiffness * scale, in_hand.translation_stiffness);
        EXPECT_DOUBLE_EQ(at_tool.rotation_stiffness / scale, in_hand.rotation_stiffness);
        EXPECT_DOUBLE_EQ(at_tool.saturation_torque / scale, in_hand.saturation_torque);
        EXPECT_EQ(scaled.hand.max_torque, plain.hand.max_torque);
    }
}

TEST(ToolConfigOfAScene, DefaultsOfTheSceneAreTheDefaultsOfTheCode) {
    const ToolConfig scene = toolConfigOf(LoadedScene{}, scene::Tool{});
    const ToolConfig code;
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_EQ(scene.mesh_path, code.mesh_path);
    EXPECT_EQ(scene.burr_kind, code.burr_kind);
    EXPECT_DOUBLE_EQ(scene.burr_radius, code.burr_radius);
    EXPECT_DOUBLE_EQ(scene.burr_length, code.burr_length);
    EXPECT_DOUBLE_EQ(scene.burr_tip_radius, code.burr_tip_radius);
    EXPECT_EQ(scene.sdf_nodes, code.sdf_nodes);
    EXPECT_DOUBLE_EQ(scene.sdf_spacing, code.sdf_spacing);
    EXPECT_EQ(scene.sdf_origin_T, code.sdf_origin_T);
}

}  // namespace
}  // namespace bonemill
