// Compares the simulated plant with closed-form mechanics.
#include "tests/stability/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace bonemill::test {
namespace {

DevicePlant frictionless() {
    DevicePlant device;
    device.damping = device.coulomb = device.angular_damping = device.angular_coulomb = 0;
    device.encoder_step = device.encoder_angle = 0;
    return device;
}
HandPlant undamped() {
    HandPlant hand;
    hand.damping = hand.angular_damping = 0;
    return hand;
}
const Wrench kNothing;

TEST(Plant, FallsAsAFreeMass) {
    Plant plant(frictionless(), kNoHand, {});
    plant.setBias({{0, 0, -frictionless().mass * 9.81}, {0, 0, 0}});
    for (int n = 0; n < 200; ++n) plant.advance(1e-3, kNothing);
    EXPECT_NEAR(plant.pose().position.z(), -9.81 * 0.2 * 0.2 / 2, 1e-9);
    EXPECT_NEAR(plant.velocity().z(), -9.81 * 0.2, 1e-9);
}

TEST(Plant, SwingsAtTheFrequencyOfItsSpring) {
    const DevicePlant device = frictionless();
    const HandPlant hand = undamped();
    Plant plant(device, hand, {});
    plant.setTarget({{1e-3, 0, 0}, expRotation({0, 0.1, 0})});
    const double period = 2 * std::numbers::pi * std::sqrt((device.mass + hand.mass) / hand.stiffness);
    plant.advance(period / 2, kNothing);
    EXPECT_NEAR(plant.pose().position.x(), 2e-3, 1e-8);
    plant.advance(period / 2, kNothing);
    EXPECT_NEAR(plant.pose().position.x(), 0, 1e-8);
    const double turn_period =
        2 * std::numbers::pi * std::sqrt((device.inertia + hand.inertia) / hand.angular_stiffness);
    Plant turning(device, hand, {});
    turning.setTarget({{0, 0, 0}, expRotation({0, 0.1, 0})});
    turning.advance(turn_period / 2, kNothing);
    EXPECT_NEAR(logRotation(turning.pose().rotation).y(), 0.2, 1e-5);
}

TEST(Plant, KeepsItsEnergyWithoutFriction) {
    Plant plant(frictionless(), undamped(), {});
    plant.setTarget({{1e-3, -2e-3, 0}, expRotation({0.2, 0.1, 0.05})});
    const double before = plant.energy();
    double low = before, high = before;
    for (int n = 0; n < 2000; ++n) {
        plant.advance(1e-3, kNothing);
        low = std::min(low, plant.energy());
        high = std::max(high, plant.energy());
    }
    EXPECT_NEAR(low / before, 1, 2e-3);  // leapfrog swings by about (ωh)², and never drifts
    EXPECT_NEAR(high / before, 1, 2e-3);
    EXPECT_NEAR(plant.energy() / before, 1, 2e-3);
}

TEST(Plant, FrictionOnlyEverTakesEnergy) {
    Plant plant({}, {}, {});
    plant.setTarget({{1e-3, 2e-3, 3e-3}, expRotation({0.2, 0, 0})});
    double before = plant.energy();
    for (int n = 0; n < 1000; ++n) {
        plant.advance(1e-3, kNothing);
        EXPECT_LE(plant.energy(), before * (1 + 1e-12));
        before = plant.energy();
    }
}

TEST(Plant, SticksBelowCoulombAndSlidesAbove) {
    DevicePlant device;
    Plant stuck(device, kNoHand, {});
    for (int n = 0; n < 500; ++n) stuck.advance(1e-3, {{0.99 * device.coulomb, 0, 0}, {0, 0, 0}});
    EXPECT_EQ(stuck.pose().position, Eigen::Vector3d::Zero());
    Plant slides(device, kNoHand, {});
    for (int n = 0; n < 3000; ++n) slides.advance(1e-3, {{2 * device.coulomb, 0, 0}, {0, 0, 0}});
    EXPECT_NEAR(slides.velocity().x(), device.coulomb / device.damping, 1e-6);
}

TEST(Plant, AmplifierLagsByItsPole) {
    DevicePlant device = frictionless();
    Plant plant(device, kNoHand, {});
    const double t = 0.1, force = 0.5;
    plant.advance(t, {{force, 0, 0}, {0, 0, 0}});
    const double lag = 1 / (2 * std::numbers::pi * device.amplifier_hz);
    EXPECT_NEAR(plant.velocity().x(), force / device.mass * (t - lag), force / device.mass * lag * 0.05);
}

TEST(Plant, EncodersRoundToTheNearestStep) {
    DevicePlant device;
    const double step = device.encoder_step, angle = device.encoder_angle;
    const Pose start{{0, 0, 0}, expRotation({0.3, 0.2, -0.4})};
    Plant plant(device, kNoHand, start);
    plant.setVelocity({0.1, -0.07, 0.03}, {0.5, 0.2, -0.3});
    for (int n = 0; n < 50; ++n) {
        plant.advance(1e-3, kNothing);
        const Eigen::Vector3d error = plant.measured().position - plant.pose().position;
        EXPECT_LE(error.cwiseAbs().maxCoeff(), step / 2 * (1 + 1e-9));
        const Eigen::Vector3d steps = plant.measured().position / step;
        EXPECT_LT((steps.array() - steps.array().round()).abs().maxCoeff(), 1e-6);
        const Eigen::Vector3d seen = logRotation(plant.measured().rotation * start.rotation.conjugate());
        const Eigen::Vector3d truth = logRotation(plant.pose().rotation * start.rotation.conjugate());
        EXPECT_LE((seen - truth).cwiseAbs().maxCoeff(), angle / 2 * (1 + 1e-6));
    }
    EXPECT_GT(plant.pose().position.norm(), 1e-3);  // it did move
}

}  // namespace
}  // namespace bonemill::test
