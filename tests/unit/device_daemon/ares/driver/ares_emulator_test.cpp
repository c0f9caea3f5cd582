#include "device_daemon/ares/driver/ares_emulator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bonemill {
namespace {

constexpr double kPeriod = 1e-3;  // s

AresPlant frictionless() {
    AresPlant plant;
    plant.coulomb_friction = 0;
    return plant;
}

HandImpedance noHand() {
    return {0, 0, 0, 0, 0, 0};
}

// Returns the actuator forces that push the handle with this wrench where it is now.
Vector6d forcesFor(const AresEmulator& emulator, const Wrench& wrench) {
    Matrix6d J_inv;
    EXPECT_TRUE(AresKinematics{}.inverseJacobian(emulator.state().X_DT, J_inv));
    return actuatorForces(J_inv, wrench);
}

void push(AresEmulator& emulator, const Wrench& wrench, double seconds) {
    for (int i = 0; i < std::lround(seconds / kPeriod); ++i) {
        emulator.advance(kPeriod, forcesFor(emulator, wrench));
    }
}

double energyOf(const AresEmulator& emulator, const AresPlant& plant, const HandImpedance& hand) {
    const EmulatorState& state = emulator.state();
    const Eigen::Vector3d stretch = state.target.X_DT.position - state.X_DT.position;
    const Eigen::Vector3d turn = logRotation(state.target.X_DT.rotation * state.X_DT.rotation.conjugate());
    return 0.5 * ((plant.moving_mass + hand.mass) * state.v_DT.squaredNorm() +
                  (plant.moving_inertia + hand.inertia) * state.w_DT.squaredNorm() +
                  hand.stiffness * stretch.squaredNorm() + hand.angular_stiffness * turn.squaredNorm());
}

JointReading readingOf(AresEmulator& emulator, double elapsed) {
    JointReading reading;
    EXPECT_TRUE(emulator.readJoints(elapsed, reading));
    return reading;
}

TEST(AresEmulator, StaysAtRestExactly) {
    AresEmulator emulator(AresKinematics{}, {}, {}, OperatorPath{});
    emulator.advance(1.0, Vector6d::Zero());
    EXPECT_EQ(emulator.state().X_DT.position, Eigen::Vector3d::Zero());
    EXPECT_EQ(emulator.state().v_DT, Eigen::Vector3d::Zero());
    EXPECT_EQ(logRotation(emulator.state().X_DT.rotation), Eigen::Vector3d::Zero());
}

TEST(AresEmulator, ConstantWrenchDeflectsTheHandLikeItsSpring) {
    const HandImpedance hand;
    AresEmulator emulator(AresKinematics{}, frictionless(), hand, OperatorPath{});
    const Wrench wrench{{3, -2, 1}, {0.05, 0.1, -0.15}};
    push(emulator, wrench, 3.0);
    const Pose& X_DT = emulator.state().X_DT;
    EXPECT_LT((X_DT.position - wrench.force / hand.stiffness).norm(), 1e-9);
    EXPECT_LT((logRotation(X_DT.rotation) - wrench.torque / hand.angular_stiffness).norm(), 1e-8);
}

TEST(AresEmulator, CoulombFrictionLeavesTheHandShortOfItsDeflection) {
    const HandImpedance hand;
    const AresPlant plant;
    AresEmulator emulator(AresKinematics{}, plant, hand, OperatorPath{});
    push(emulator, {{3, 0, 0}, {0, 0, 0}}, 3.0);
    EXPECT_EQ(emulator.state().v_DT, Eigen::Vector3d::Zero());  // sticks
    EXPECT_LE(std::abs(3 - hand.stiffness * emulator.state().X_DT.position.x()), plant.coulomb_friction);
}

TEST(AresEmulator, AFreeHandleSticksBelowAndMovesAboveCoulombFriction) {
    AresPlant plant;
    plant.coulomb_friction = 0.2;
    AresEmulator emulator(AresKinematics{}, plant, noHand(), OperatorPath{});
    push(emulator, {{0.15, 0, 0}, {0, 0, 0}}, 1.0);
    EXPECT_EQ(emulator.state().X_DT.position, Eigen::Vector3d::Zero());

    AresEmulator other(AresKinematics{}, plant, noHand(), OperatorPath{});
    push(other, {{0.25, 0, 0}, {0, 0, 0}}, 1.5);
    EXPECT_GT(other.state().X_DT.position.x(), 1e-3);
    // The terminal speed is what friction leaves of the force, over the viscous friction.
    EXPECT_NEAR(other.state().v_DT.x(), 0.05 / plant.viscous_friction, 1e-5);
}

TEST(AresEmulator, FreeMotionOnlyLosesEnergy) {
    const AresPlant plant = frictionless();
    const HandImpedance hand;
    // The hand jumps within 1 ms and then rests: what follows is a free swing.
    const OperatorPath path(
        {{0, Pose{}, 0}, {1e-3, {{0.01, -0.005, 0.008}, expRotation({0.2, -0.1, 0.3})}, 0}});
    AresEmulator emulator(AresKinematics{}, plant, hand, path);
    emulator.startScenario();
    emulator.advance(2e-3, Vector6d::Zero());
    const double start = energyOf(emulator, plant, hand);
    double highest_so_far = start;
    for (int i = 0; i < 1000; ++i) {
        emulator.advance(kPeriod, Vector6d::Zero());
        const double energy = energyOf(emulator, plant, hand);
        // Semi-implicit Euler keeps a modified energy: allow its ripple of a fraction h·omega.
        EXPECT_LT(energy, highest_so_far * (1 + 1e-3));
        highest_so_far = std::min(highest_so_far, energy);
    }
    EXPECT_LT(highest_so_far, 1e-6 * start);
}

TEST(AresEmulator, AmplifierHasAFirstOrderPole) {
    AresPlant plant;
    plant.amplifier_bandwidth_hz = 100;
    AresEmulator emulator(AresKinematics{}, plant, {}, OperatorPath{});
    emulator.advance(kPeriod, Vector6d::Constant(5));
    const double expected = 5 * (1 - std::exp(-2 * M_PI * 100 * kPeriod));
    for (const double force : emulator.state().actuator_forces) EXPECT_NEAR(force, expected, 1e-12);
}

TEST(AresEmulator, EncodersReportWholeSteps) {
    AresPlant plant;
    plant.encoder_step = 2e-5;
    AresEmulator emulator(AresKinematics{}, plant, {},
                          OperatorPath({{0, {{1.234e-3, 5.67e-4, 8.9e-5}, expRotation({0.01, 0, 0.02})}}}));
    const Vector6d q = readingOf(emulator, 0).q;
    Vector6d exact;
    ASSERT_TRUE(AresKinematics{}.inverse(emulator.state().X_DT, exact));
    EXPECT_LE((q - exact).cwiseAbs().maxCoeff(), plant.encoder_step / 2 * (1 + 1e-9));
    EXPECT_GT((q - exact).norm(), 1e-7);
    for (const double slider : q) {
        EXPECT_NEAR(slider / plant.encoder_step, std::round(slider / plant.encoder_step), 1e-9);
    }
    plant.encoder_step = 0;
    AresEmulator ideal(AresKinematics{}, plant, {}, OperatorPath({{0, emulator.state().X_DT}}));
    EXPECT_EQ(readingOf(ideal, 0).q, exact);
}

TEST(AresEmulator, TheHandFollowsItsPathAndPressesItsButtons) {
    const Pose goal{{0.015, 0.005, -0.01}, expRotation({0.3, 0, 0.2})};
    const OperatorPath path({{0, Pose{}, 1}, {1.0, goal, 2}});
    AresEmulator emulator(AresKinematics{}, {}, {}, path);
    EXPECT_EQ(readingOf(emulator, 0.5).buttons, 0u);  // the scenario has not started
    EXPECT_EQ(emulator.state().X_DT.position, Eigen::Vector3d::Zero());
    emulator.startScenario();
    EXPECT_EQ(readingOf(emulator, 0.02).buttons, 1u);
    for (int i = 0; i < 2000; ++i) readingOf(emulator, kPeriod);
    EXPECT_EQ(readingOf(emulator, 0).buttons, 2u);
    EXPECT_GE(emulator.state().scenario_time, path.duration());
    EXPECT_LT((emulator.state().X_DT.position - goal.position).norm(),
              0.2 / 600 + 1e-6);  // Coulomb / stiffness
    EXPECT_LT(logRotation(goal.rotation * emulator.state().X_DT.rotation.conjugate()).norm(), 1e-4);
}

TEST(AresEmulator, NeverLeavesTheWorkspace) {
    const AresKinematics kinematics;
    AresEmulator emulator(kinematics, {}, noHand(), OperatorPath{});
    push(emulator, {{0, 0, 20}, {0, 0, 0}}, 2.0);
    EXPECT_TRUE(emulator.state().at_stop);
    EXPECT_EQ(kinematics.workspaceFaults(emulator.state().X_DT), kWorkspaceOk);
    EXPECT_NEAR(emulator.state().X_DT.position.z(), kinematics.geometry().stroke / 2, 1e-3);
    push(emulator, {{0, 0, -20}, {0, 0, 0}}, 0.05);
    EXPECT_FALSE(emulator.state().at_stop);  // and comes back
}

TEST(AresEmulator, RepeatsBitForBit) {
    const OperatorPath path({{0, Pose{}, 0}, {0.2, {{0.01, 0.01, 0.01}, expRotation({0.3, 0.2, 0.1})}, 0}},
                            1e-4);
    AresEmulator first(AresKinematics{}, {}, {}, path), second(AresKinematics{}, {}, {}, path);
    first.startScenario();
    second.startScenario();
    for (int i = 0; i < 300; ++i) {
        first.advance(kPeriod, Vector6d::Constant(0.1 * (i % 7)));
        second.advance(kPeriod, Vector6d::Constant(0.1 * (i % 7)));
    }
    EXPECT_EQ(first.state().X_DT.position, second.state().X_DT.position);
    EXPECT_EQ(first.state().X_DT.rotation.coeffs(), second.state().X_DT.rotation.coeffs());
}

TEST(AresEmulator, OneLongPauseOfTheLoopIsBounded) {
    AresEmulator emulator(AresKinematics{}, {}, {}, OperatorPath({{0, Pose{}}, {10, Pose{}}}));
    emulator.startScenario();
    readingOf(emulator, 100);
    EXPECT_NEAR(emulator.state().scenario_time, AresEmulator::kLongestElapsed, 1e-9);
}

TEST(AresEmulator, WithPlayTheSlidersLieWhereTheirMotorsPush) {
    AresPlant plant;
    plant.play = 40e-6;
    plant.encoder_step = 0;
    AresEmulator loose(AresKinematics{}, plant, {}, OperatorPath());
    plant.play = 0;
    AresEmulator tight(AresKinematics{}, plant, {}, OperatorPath());
    const auto offset = [&](double force) {
        for (AresEmulator* emulator : {&loose, &tight}) emulator->advance(0.01, Vector6d::Constant(force));
        return (readingOf(loose, 0).q - readingOf(tight, 0).q).eval();
    };
    EXPECT_LT(offset(0).norm(), 1e-12);
    EXPECT_LT((offset(0.1) - Vector6d::Constant(20e-6)).norm(), 1e-12);
    EXPECT_LT((offset(-0.1) - Vector6d::Constant(-20e-6)).norm(), 1e-12);
    // Without force a slider stays behind until the link has come through the gap.
    const Vector6d dragged = offset(0);
    EXPECT_LE(dragged.maxCoeff(), 20e-6);
    EXPECT_GE(dragged.minCoeff(), -20e-6);
}

TEST(AresEmulator, AnUnbalancedMassPullsTheHandleDown) {
    AresPlant plant = frictionless();
    plant.unbalanced_mass = 0.1;
    const HandImpedance hand;
    AresEmulator emulator(AresKinematics{}, plant, hand, OperatorPath());
    push(emulator, {}, 2);
    EXPECT_NEAR(emulator.state().X_DT.position.z(), -0.1 * 9.81 / hand.stiffness, 1e-6);
    push(emulator, {{0, 0, 0.1 * 9.81}, Eigen::Vector3d::Zero()}, 2);
    EXPECT_NEAR(emulator.state().X_DT.position.z(), 0, 1e-6) << "compensated";
}

TEST(AresEmulator, ShortedMotorsBrake) {
    const auto speedAfter = [](bool is_braked) {
        AresEmulator emulator(AresKinematics{}, frictionless(), noHand(), OperatorPath());
        push(emulator, {{1, 0, 0}, Eigen::Vector3d::Zero()}, 0.02);
        emulator.setBraked(is_braked);
        push(emulator, {}, 0.02);
        return emulator.state().v_DT.norm();
    };
    EXPECT_LT(speedAfter(true), 0.3 * speedAfter(false));
}

TEST(AresEmulator, APausedScenarioHoldsItsTimeAndTheHandDrawsBack) {
    AresEmulator emulator(
        AresKinematics{}, {}, {},
        OperatorPath({{0, Pose{}, 0}, {1, {{0.01, 0, 0}, Eigen::Quaterniond::Identity()}, 0}}));
    emulator.startScenario();
    push(emulator, {}, 0.5);
    emulator.pauseScenario();
    const Eigen::Vector3d wish = emulator.state().target.X_DT.position;
    push(emulator, {}, 1);
    EXPECT_NEAR(emulator.state().scenario_time, 0.5, 1e-9);
    EXPECT_LT(emulator.state().target.X_DT.position.norm(), 1e-12);  // where the path starts
    EXPECT_EQ(emulator.state().target.v_DT.norm(), 0);
    emulator.startScenario();
    push(emulator, {}, 0.7);
    EXPECT_NEAR(emulator.state().scenario_time, 0.5, 1e-3);  // it returns first
    EXPECT_LT((emulator.state().target.X_DT.position - wish).norm(), 1e-5);
    push(emulator, {}, 0.25);
    EXPECT_NEAR(emulator.state().scenario_time, 0.75, 2e-3);
}

TEST(AresEmulator, AScenarioThatBeginsAnewDoesSoFromWhereItStarts) {
    AresEmulator emulator(
        AresKinematics{}, {}, {},
        OperatorPath({{0, Pose{}, 1}, {1, {{0.01, 0, 0}, Eigen::Quaterniond::Identity()}, 1}}));
    emulator.beginAnew();
    emulator.startScenario();
    push(emulator, {}, 0.8);
    EXPECT_NEAR(emulator.state().scenario_time, 0.8, 1e-9) << "it had not begun";
    emulator.beginAnew();
    double largest_step = 0;
    for (int i = 0; i < 1000; ++i) {
        const Eigen::Vector3d before = emulator.state().target.X_DT.position;
        push(emulator, {}, 1e-3);
        largest_step = std::max(largest_step, (emulator.state().target.X_DT.position - before).norm());
        if (i < 690) EXPECT_EQ(emulator.state().target.buttons, 0u);
    }
    EXPECT_LT(largest_step, 2.5e-5) << "no jump";
    EXPECT_NEAR(emulator.state().scenario_time, 0.3, 2e-3);
    EXPECT_EQ(emulator.state().target.buttons, 1u);
    emulator.pauseScenario();
    push(emulator, {}, 1);
    emulator.beginAnew();
    push(emulator, {}, 0.1);
    emulator.startScenario();
    push(emulator, {}, 0.1);
    EXPECT_NEAR(emulator.state().scenario_time, 0.1, 2e-3) << "it was there already";
}

TEST(AresEmulator, SaysHowFastItsSlidersMove) {
    AresEmulator emulator(AresKinematics{}, {}, noHand(), OperatorPath());
    push(emulator, {{1, 0, 2}, Eigen::Vector3d::Zero()}, 0.05);
    const JointReading before = readingOf(emulator, 0);
    constexpr double kStep = 1e-3;
    emulator.advance(kStep, Vector6d::Zero());
    const JointReading after = readingOf(emulator, 0);
    EXPECT_LT((0.5 * (before.q_dot + after.q_dot) - (after.q - before.q) / kStep).norm(), 0.02);
}

}  // namespace
}  // namespace bonemill
