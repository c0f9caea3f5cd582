// Feels friction and cutting force as the hand does, through the whole tick.
#include <gtest/gtest.h>

#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"
#include "tests/support/typical_effects.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

constexpr double kFriction = 0.3;

FixedTickConfig& withoutMilling(FixedTickConfig& config) {
    config.effects = {};
    return config;
}
void stick(FixedTickConfig& config) {
    withoutMilling(config).effects.surface_friction = {kFriction, 5e4};
}
const Variant& balanced() {
    static const Variant kBalanced{"balanced", Preset::kBalanced};
    return kBalanced;
}

constexpr double kFarEnough = 1e-3;  // m

// The hand goes along with the tool and pulls with a constant force, `tangent` of its angle to the normal.
// Returns how far the tool goes in `ticks`, m, once it is pressed and pulled.
double wayUnder(double tangent, int settle_ticks, int ticks) {
    Scene scene(planeBone(), burr(), balanced(), 1e-3, stick);
    Stepper stepper(scene);
    const double depth = 0.6e-3;
    for (int n = 0; n < 200; ++n)
        stepper.step(abovePlane(0.05e-3 - (depth + 0.05e-3) * std::min(1.0, n / 100.0)));
    const double pull =
        stepper.wrenchOnHand().force.z() / couplingFigures(scene.config).translation_stiffness;
    const double down = stepper.spo().position.z() - pull;
    double along = 0;
    const auto drive = [&](int ticks) {
        for (int n = 0; n < ticks; ++n) {
            along = std::min(along + 2e-6, tangent * pull);
            stepper.step(upright({stepper.spo().position.x() + along, kMiddle.y(), down}));
            if (stepper.spo().position.x() - kMiddle.x() > kFarEnough) return;
        }
    };
    drive(settle_ticks);
    const double start = stepper.spo().position.x();
    drive(ticks);
    EXPECT_TRUE(stepper.isFinite());
    EXPECT_GT(stepper.record().contacts, 0u);
    return stepper.spo().position.x() - start;
}

TEST(FrictionInTick, SticksBelowTheFrictionAngleForAMinute) {
    EXPECT_LT(std::abs(wayUnder(0.95 * kFriction, 500, 60'000)), 1e-9);
}
TEST(FrictionInTick, SlidesAboveIt) {
    EXPECT_GT(wayUnder(1.05 * kFriction, 100, 300), 0.1e-3);
}

struct Drag {
    double mean, spread, normal;
};
// Measures the force along the way while the tool is drawn over the plane.
Drag dragAt(double speed, const Variant& variant) {
    Scene scene(planeBone(), burr(), variant, 1e-3, stick);
    Stepper stepper(scene);
    for (int n = 0; n < 300; ++n) stepper.step(abovePlane(-2e-3 * std::min(1.0, n / 200.0)));
    double sum = 0, squares = 0, normal = 0;
    const int lead_in = int(1.2e-3 / speed * 1e3), ticks = int(0.3e-3 / speed * 1e3);
    for (int n = 0; n < lead_in + ticks; ++n) {
        Pose device = abovePlane(-2e-3);
        device.position.x() += speed * n * 1e-3;
        stepper.step(device);
        if (n < lead_in) continue;
        const Vector3d force = stepper.wrenchOnHand().force;
        sum -= force.x(), squares += force.x() * force.x(), normal += force.z();
    }
    const double mean = sum / ticks;
    return {mean, std::sqrt(std::max(0.0, squares / ticks - mean * mean)), normal / ticks};
}

TEST(FrictionInTick, SlidingCostsFrictionTimesForceWithoutChatter) {
    for (const Preset preset : {Preset::kFast, Preset::kBalanced, Preset::kExact})
        for (const double speed : {1e-3, 10e-3}) {
            const Drag drag = dragAt(speed, {std::string(presetName(preset)), preset});
            // With one iteration a tick the tool lags behind what it should do.
            const double slack = preset == Preset::kFast ? 0.05 : 0.02;
            const double air = 3 * speed;  // of the solve's damping: τ k_t = 3 N·s/m
            EXPECT_NEAR(drag.mean - air, kFriction * drag.normal, slack * kFriction * drag.normal)
                << presetName(preset) << " at " << speed;
            EXPECT_LT(drag.spread, slack / 2 * drag.mean) << presetName(preset) << " at " << speed;
        }
}

// The burr lies sidewards on the plane: the torque about the shaft is M = μ F R, and no force but the cutting
// force's lies across.
Wrench pressedWhileSpinning(bool cutting, TickRecord& record) {
    Scene scene(planeBone(), burr(), balanced(), 1e-3, [=](FixedTickConfig& config) {
        withoutMilling(config).tool.burr.speed = 4000;
        if (cutting) config.effects.cutting_force = test::kCuttingForce;
    });
    Stepper stepper(scene);
    for (int n = 0; n < 1000; ++n)
        record = stepper.step(abovePlane(-1.5e-3 * std::min(1.0, n / 200.0)), kButtonRemove);
    return stepper.wrenchOnHand();
}

TEST(CuttingForceInTick, GivesTheHandTheSixthDegreeOfFreedom) {
    TickRecord without, with;
    const Wrench quiet = pressedWhileSpinning(false, without), felt = pressedWhileSpinning(true, with);
    EXPECT_LT(std::abs(quiet.torque.y()), 1e-3 * std::abs(felt.torque.y()));
    EXPECT_EQ(without.effects.axis_torque, 0);
    const double normal = felt.force.z(), friction = Burr{}.friction;
    EXPECT_GT(normal, 2);
    // The contacts lie between the burr's surface and as much farther in as the burr is deep.
    const double lever = -felt.torque.y() / (friction * with.effects.burr_force);
    EXPECT_LE(lever, kBurrRadius);
    EXPECT_GE(lever, kBurrRadius - with.max_penetration);
    EXPECT_NEAR(with.effects.axis_torque, -felt.torque.y(), 1e-3 * std::abs(felt.torque.y()));
    EXPECT_NEAR(with.effects.axis_torque * with.effects.spin_speed, with.effects.cutting_power,
                0.01 * with.effects.cutting_power);
    // At the bottom Ω a × r is along −x, with a = y and r = −z; friction pulls the tool along +x.
    EXPECT_NEAR(felt.force.x(), friction * normal, 0.05 * friction * normal);
}

// The motor is too weak: the burr stands, and the hand holds the whole torque of the motor.
TEST(CuttingForceInTick, AStalledBurrHoldsTheMotorsTorque) {
    constexpr double kWeak = 0.2e-3;  // N·m
    Scene scene(planeBone(), burr(), balanced(), 1e-3, [](FixedTickConfig& config) {
        withoutMilling(config).tool.burr.speed = 4000;
        config.effects.cutting_force = test::kCuttingForce;
        config.effects.spindle = test::kSpindle;
        config.effects.spindle->max_torque = kWeak;
    });
    Stepper stepper(scene);
    for (int n = 0; n < 1500; ++n)
        stepper.step(abovePlane(-1.5e-3 * std::min(1.0, n / 200.0)), kButtonRemove);
    const EffectRecord& record = stepper.record().effects;
    EXPECT_TRUE(record.events & kEventSpindleStalled);
    EXPECT_EQ(record.spin_speed, 0);
    EXPECT_NEAR(record.axis_torque, kWeak, 0.01 * kWeak);
    EXPECT_NEAR(-stepper.wrenchOnHand().torque.y(), kWeak, 0.01 * kWeak);
}

}  // namespace
}  // namespace bonemill::test
