#include "haptic_server/core/effects/surface_friction/surface_friction.h"

#include <gtest/gtest.h>

#include "tests/support/contact_set.h"
#include "tests/support/eigenvalues.h"
#include "tests/support/energy_check.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr SurfaceFrictionConfig kConfig{.coefficient = 0.3, .presliding_stiffness = 5e4};
constexpr double kRadius = 1e-3;

// The tool stands on contacts and is moved by hand.
struct FrictionTest : testing::Test {
    FrictionTest() {
        bench.tick.spin_speed = 0;
        bench.tick.is_pedal_down = false;
    }
    void standOnPlane(double force) {
        contacts = {};
        contacts.add({0, 0, -kRadius}, {0, 0, 1}, force);
    }
    void standOnRing(double radius) {
        contacts = {};
        for (int n = 0; n < 36; ++n) {
            const double angle = 2 * M_PI * n / 36;
            contacts.add({radius * std::cos(angle), radius * std::sin(angle), 0}, {0, 0, 1}, 5.0 / 36, 0,
                         false);
        }
    }
    // Runs one tick that ends at `pose` and returns the wrench there.
    Wrench moveTo(const Pose& pose) {
        EffectTick& tick = bench.tick;
        contacts.giveTo(tick);
        tick.X_VT_start = tick.X_VT;
        friction.begin(tick);
        const EnergyTerm before = friction.energy(tick, tick.X_VT_start), after = friction.energy(tick, pose);
        given_to_friction += after.energy - before.energy;
        tick.X_VT = pose;
        friction.finish(tick);
        return after.wrench;
    }
    Wrench moveBy(const Vector3d& x, const Vector3d& turn = Vector3d::Zero()) {
        return moveTo(bench.tick.X_VT.incremented(x, turn));
    }
    double width(double force) const { return kConfig.coefficient * force / kConfig.presliding_stiffness; }

    std::mt19937 random{11};
    test::BurrTick bench;
    test::ContactSet contacts;
    SurfaceFriction friction{kConfig};
    double given_to_friction = 0;  // J
};

TEST_F(FrictionTest, SticksAsASpringAndComesBackToIt) {
    standOnPlane(5);
    const double x = 0.5 * width(5);
    EXPECT_NEAR(moveBy({x, 0, 0}).force.x(), -kConfig.presliding_stiffness * x, 1e-6);
    EXPECT_NEAR(moveBy({-x, 0, 0}).force.norm(), 0, 1e-9);
    EXPECT_NEAR(given_to_friction, 0, 1e-15);
}

TEST_F(FrictionTest, SlidesWithFrictionTimesForceAgainstTheMotion) {
    standOnPlane(5);
    const Vector3d step = 20e-6 * Vector3d(0.6, -0.8, 0);
    for (int n = 0; n < 50; ++n) moveBy(step);
    const Vector3d force = moveBy(step).force;
    EXPECT_LT((force + kConfig.coefficient * 5 * step.normalized()).norm(), 1e-5);
    EXPECT_EQ(moveBy({0, 0, 1e-6}).force.z(), 0);
}

TEST_F(FrictionTest, HeatIsFrictionTimesWay) {
    standOnPlane(5);
    for (int n = 0; n < 100; ++n) moveBy({20e-6, 0, 0});
    EXPECT_NEAR(given_to_friction, kConfig.coefficient * 5 * 2e-3, 0.02 * kConfig.coefficient * 5 * 2e-3);
}

// The load flickers while the tool is held: what it holds with stays.
TEST_F(FrictionTest, AFlickeringLoadDoesNotLetItCreep) {
    standOnPlane(5);
    const Vector3d held = moveBy({0.5 * width(5), 0, 0}).force;
    for (int n = 0; n < 1000; ++n) {
        standOnPlane(n % 2 ? 5 : 4);
        moveBy(Vector3d::Zero());
    }
    EXPECT_LT((moveBy(Vector3d::Zero()).force - held).norm(), 1e-9);
}

TEST_F(FrictionTest, LetsGoWithTheLoad) {
    standOnPlane(5);
    moveBy({0.9 * width(5), 0, 0});
    standOnPlane(1);
    EXPECT_NEAR(moveBy(Vector3d::Zero()).force.norm(), kConfig.coefficient * 1, 1e-6);
    contacts = {};
    EXPECT_EQ(moveBy(Vector3d::Zero()).force.norm(), 0);
    standOnPlane(5);
    EXPECT_EQ(moveBy(Vector3d::Zero()).force.norm(), 0);
}

TEST_F(FrictionTest, IsMinusTheGradientOfItsEnergyStickingAndSlipping) {
    contacts.addOnBall(random, kRadius, 40);
    const double total = [&] {
        double sum = 0;
        for (const SurfaceContact& contact : contacts.contacts) sum += double(contact.force);
        return sum;
    }();
    for (const double of_width : {0.3, 1.0, 30.0}) {
        friction.restart(Restart::kOtherTool);
        bench.tick.X_VT = {{1e-3, -1e-3, 2e-3}, expRotation({0.2, 0.5, -0.3})};
        moveBy(of_width * width(total) * Vector3d(0.3, 0.5, -0.1),
               of_width * width(total) / kRadius * Vector3d(-0.2, 0.1, 0.6));
        bench.tick.X_VT_start = bench.tick.X_VT;
        const auto energy = [&](const Pose& pose) { return friction.energy(bench.tick, pose); };
        const Pose pose =
            bench.tick.X_VT_start.incremented(of_width * width(total) * Vector3d(0.1, 0.4, 0.2),
                                              of_width * width(total) / kRadius * Vector3d(0.3, 0, -0.2));
        ASSERT_GT(energy(pose).energy, 0);
        test::expectWrenchIsGradient(energy, pose, 1e-4 * width(total), kRadius,
                                     1e-4 * kConfig.coefficient * total);
    }
}

// The stiffness equals differences of the wrench where the energy is smooth, and is never negative.
TEST_F(FrictionTest, StiffnessIsSemiDefiniteAndThatOfAStickingTool) {
    contacts.addOnBall(random, kRadius, 40);
    moveBy({1e-6, 0, 0});
    for (const double reach : {1e-7, 1e-5, 1e-3}) {
        const Pose pose = bench.tick.X_VT.incremented(reach * test::randomVector(random),
                                                      reach / kRadius * test::randomVector(random));
        const Matrix6d K = friction.energy(bench.tick, pose).stiffness;
        EXPECT_LT((K - K.transpose()).norm(), 1e-9 * K.norm());
        const Vector6d unit = (Vector6d() << 1, 1, 1, 1e3, 1e3, 1e3).finished();
        const Matrix6d scaled = unit.asDiagonal() * K * unit.asDiagonal();
        const Vector6d modes = test::eigenvaluesOf(scaled);
        EXPECT_GE(modes[0], -1e-12 * modes[5]);
    }
    const Matrix6d K = friction.energy(bench.tick, bench.tick.X_VT).stiffness;
    constexpr double kStep = 1e-8;
    const Wrench at = friction.energy(bench.tick, bench.tick.X_VT).wrench;
    for (int n = 0; n < 3; ++n) {
        const Pose moved = bench.tick.X_VT.incremented(kStep * Vector3d::Unit(n), Vector3d::Zero());
        const Vector3d change = friction.energy(bench.tick, moved).wrench.force - at.force;
        EXPECT_LT((change / -kStep - Vector3d(K.block<3, 1>(0, n))).norm(), 1e-4 * K(n, n));
    }
}

// Contacts come, go and change, the tool shakes and turns: at no time has friction given more than it got.
TEST_F(FrictionTest, NeverDrives) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int trial = 0; trial < 20; ++trial) {
        friction.restart(Restart::kOtherTool);
        given_to_friction = 0;
        bench.tick.X_VT = {};
        double most = 0;
        for (int n = 0; n < 1000; ++n) {
            if (n % 7 == 0) {
                contacts = {};
                contacts.addOnBall(random, kRadius, int(1 + 30 * uniform(random)));
            }
            if (n % 50 == 0) contacts = {};
            bench.tick.spin_speed = n % 13 == 0 ? 20 * uniform(random) : 0;
            const double reach = 30e-6 * std::pow(uniform(random), 3);
            moveBy(reach * test::randomVector(random), reach / kRadius * test::randomVector(random));
            ASSERT_GE(given_to_friction, -1e-12) << "trial " << trial << ", tick " << n;
            most = std::max(most, given_to_friction);
        }
        EXPECT_GT(most, 1e-6);
    }
}

// The tool is turned on a narrow contact and back on a wide one, where the same turn stretches more.
TEST_F(FrictionTest, AWiderContactGivesBackNoMoreThanTheNarrowOneGot) {
    for (int n = 0; n < 20; ++n) {
        standOnRing((n % 2 ? 1 : 0.5) * kRadius);
        moveBy(Vector3d::Zero(), {0, 0, (n % 2 ? -1 : 1) * 0.3 * width(5) / kRadius});
        ASSERT_GE(given_to_friction, -1e-15) << n;
    }
}

TEST_F(FrictionTest, ASpinningBurrDoesNotStickButItsShaftDoes) {
    standOnPlane(5);
    bench.tick.spin_speed = bench.tool.burr.speed;
    EXPECT_EQ(moveBy({1e-6, 0, 0}).force.norm(), 0);
    contacts.on_burr[0] = 0;
    EXPECT_GT(moveBy({1e-6, 0, 0}).force.norm(), 0.01);
    contacts.on_burr[0] = 1;
    bench.tick.spin_speed = 0;
    moveBy({1e-6, 0, 0});
    EXPECT_GT(moveBy({1e-6, 0, 0}).force.norm(), 0.01);
}

// A ball that rolls stretches nothing, however far it goes; that it rolled is no stretch when it slides then.
TEST_F(FrictionTest, ARollingBallIsFree) {
    standOnPlane(5);
    const double turn = 2e-3;
    for (int n = 0; n < 1000; ++n)
        ASSERT_LT(moveBy({kRadius * turn, 0, 0}, {0, turn, 0}).force.norm(), 1e-3 * kConfig.coefficient * 5);
    EXPECT_LT(friction.stretch().norm(), 1e-6);
}

TEST_F(FrictionTest, AWideContactHoldsAgainstATurnAboutItsNormal) {
    for (int n = 0; n < 36; ++n) {
        const double angle = 2 * M_PI * n / 36;
        contacts.add({kRadius * std::cos(angle), kRadius * std::sin(angle), 0}, {0, 0, 1}, 5.0 / 36, 0,
                     false);
    }
    for (int n = 0; n < 50; ++n) moveBy(Vector3d::Zero(), {0, 0, 0.01});
    const Wrench felt = moveBy(Vector3d::Zero(), {0, 0, 0.01});
    EXPECT_NEAR(felt.torque.z(), -kConfig.coefficient * 5 * kRadius,
                0.06 * kConfig.coefficient * 5 * kRadius);
    EXPECT_LT(felt.force.norm(), 1e-3);
}

}  // namespace
}  // namespace bonemill
