// What a device can do lowers what the scene says, each rule by itself.
#include "haptic_server/core/tick/hand_side.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill {
namespace {

constexpr uint32_t kSixDegrees = kAbilityForce | kAbilityTorque | kAbilityOrientation;
constexpr uint32_t kThreeDegrees = kAbilityForce | kAbilityOrientation;

// It can do more than any scene asks for.
DeviceCapabilities strongDevice() {
    return {.name = "strong",
            .kind = uint32_t(DeviceKind::kAres),
            .abilities = kSixDegrees,
            .max_force = 1000,
            .max_torque = 100,
            .max_stiffness = 1e6,
            .max_rotation_stiffness = 1e3,
            .workspace_radius = 0.1};
}
HandSide sideWith(const DeviceCapabilities& device, double scale = 1) {
    TickConfig config;
    config.hand_space = HandSpace(scale);
    return handSideOf(config, device);
}
void expectSame(const HandSide& a, const HandSide& b) {
    EXPECT_EQ(a.limits.max_force, b.limits.max_force);
    EXPECT_EQ(a.limits.max_torque, b.limits.max_torque);
    EXPECT_EQ(a.thesis.translation_stiffness, b.thesis.translation_stiffness);
    EXPECT_EQ(a.thesis.rotation_stiffness, b.thesis.rotation_stiffness);
    EXPECT_EQ(a.gradient.translation_stiffness, b.gradient.translation_stiffness);
    EXPECT_EQ(a.gradient.rotation_stiffness, b.gradient.rotation_stiffness);
    EXPECT_EQ(a.gradient.saturation_torque, b.gradient.saturation_torque);
    EXPECT_EQ(a.spring.stiffness, b.spring.stiffness);
    EXPECT_EQ(a.spring.rotation_stiffness, b.spring.rotation_stiffness);
    EXPECT_EQ(a.spring.lever, b.spring.lever);
}

TEST(HandSide, AStrongDeviceLeavesWhatTheSceneSays) {
    expectSame(sideWith(strongDevice()), handSideOf(TickConfig{}));
    DeviceCapabilities unknown = strongDevice();
    unknown.max_stiffness = unknown.max_rotation_stiffness = 0;
    expectSame(sideWith(unknown), handSideOf(TickConfig{}));
}

TEST(HandSide, TheNormsAreTheSmallerOfSceneAndDevice) {
    DeviceCapabilities device = strongDevice();
    device.max_force = 3.3;
    device.max_torque = 0.2;
    const HandSide side = sideWith(device);
    EXPECT_EQ(side.limits.max_force, 3.3);
    EXPECT_EQ(side.limits.max_torque, 0.2);
    EXPECT_EQ(side.most_pull, 3.3);
    EXPECT_EQ(side.gradient.saturation_torque, 0.2);
}

TEST(HandSide, ADeviceWithoutTorqueGetsNoneAndTheToolTurnsAsInTheScene) {
    for (const bool has_figure : {true, false}) {
        DeviceCapabilities device = strongDevice();
        if (has_figure)
            device.abilities = kThreeDegrees;
        else
            device.max_torque = 0;
        const HandSide side = sideWith(device), scene = handSideOf(TickConfig{});
        EXPECT_EQ(side.limits.max_torque, 0);
        EXPECT_EQ(side.limits.max_force, scene.limits.max_force);
        EXPECT_EQ(side.gradient.rotation_stiffness, scene.gradient.rotation_stiffness);
        EXPECT_EQ(side.gradient.saturation_torque, scene.gradient.saturation_torque);
    }
}

TEST(HandSide, ADeviceWithoutForceGetsNoneAndTheToolMovesAsInTheScene) {
    DeviceCapabilities mouse = strongDevice();
    mouse.abilities = 0;
    mouse.max_stiffness = 1;
    const HandSide side = sideWith(mouse), scene = handSideOf(TickConfig{});
    EXPECT_EQ(side.limits.max_force, 0);
    EXPECT_EQ(side.limits.max_torque, 0);
    EXPECT_EQ(side.most_pull, scene.most_pull);
    EXPECT_EQ(side.gradient.translation_stiffness, scene.gradient.translation_stiffness);
}

TEST(HandSide, NothingStifferThanTheDeviceHoldsIsRenderedNotEvenForATick) {
    DeviceCapabilities device = strongDevice();
    device.max_stiffness = 1000;
    device.max_rotation_stiffness = 0.2;
    const HandSide side = sideWith(device), scene = handSideOf(TickConfig{});
    EXPECT_DOUBLE_EQ(side.gradient.translation_stiffness * (1 + side.gradient.relaxing_share), 1000);
    EXPECT_EQ(side.thesis.translation_stiffness, 1000);
    EXPECT_EQ(side.gradient.rotation_stiffness, 0.2);
    EXPECT_EQ(side.thesis.rotation_stiffness, 0.4);
    EXPECT_EQ(side.spring.stiffness, 1000);
    EXPECT_EQ(side.spring.rotation_stiffness, 0.2);
    EXPECT_DOUBLE_EQ(side.gradient.saturation_torque / side.gradient.rotation_stiffness,
                     scene.gradient.saturation_torque / scene.gradient.rotation_stiffness);
}

// Whatever the scale, what is felt at the handle is the device's: force, torque and stiffness per its motion.
TEST(HandSide, InAScaledWorkspaceTheHandFeelsTheDevicesStiffness) {
    DeviceCapabilities device = strongDevice();
    device.max_stiffness = 1000;
    device.max_rotation_stiffness = 0.2;
    device.max_torque = 0.05;
    for (const double scale : {0.05, 0.3, 1.0, 3.0, 20.0}) {
        const HandSide side = sideWith(device, scale);
        const double felt = side.gradient.translation_stiffness * (1 + side.gradient.relaxing_share) * scale;
        EXPECT_LE(felt, 1000 * (1 + 1e-12)) << scale;
        EXPECT_LE(side.gradient.rotation_stiffness / scale, 0.2 * (1 + 1e-12)) << scale;
        EXPECT_LE(side.gradient.saturation_torque / scale, 0.05 * (1 + 1e-12)) << scale;
        EXPECT_LE(side.spring.stiffness * scale, 1000 * (1 + 1e-12)) << scale;
        EXPECT_DOUBLE_EQ(side.spring.rotation_stiffness * scale,
                         std::max(side.gradient.rotation_stiffness, side.thesis.rotation_stiffness / 2))
            << scale;
        EXPECT_EQ(side.limits.max_torque, 0.05);
    }
}

// They are plausible by their form, and say nothing that a coupling could live with.
TEST(HandSide, FiguresAtTheEdgeOfReasonLeaveACouplingThatHoldsTheTool) {
    const double odd[] = {0, 1e-9, 1e-3, 1e6};
    for (const double force : odd)
        for (const double stiffness : odd) {
            DeviceCapabilities device = strongDevice();
            device.max_force = device.max_torque = force;
            device.max_stiffness = device.max_rotation_stiffness = stiffness;
            ASSERT_TRUE(isPlausible(device));
            const HandSide side = sideWith(device);
            EXPECT_GE(side.gradient.translation_stiffness, 0.5);
            EXPECT_LE(side.gradient.translation_stiffness, 3000);
            EXPECT_GE(side.gradient.rotation_stiffness, 5e-5);
            EXPECT_GE(side.gradient.saturation_torque, 5e-5);
            EXPECT_GE(side.most_pull, 0.1);
            EXPECT_TRUE(side.limits.max_force == 0 || side.limits.max_force >= 0.1);
        }
}

}  // namespace
}  // namespace bonemill
