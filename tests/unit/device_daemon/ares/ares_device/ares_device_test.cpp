#include "device_daemon/ares/ares_device/ares_device.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "common/ares_kinematics/ares_kinematics.h"
#include "tests/support/random_direction.h"
#include "tests/unit/device_daemon/ares/ares_device/ares_bench.h"

namespace bonemill {
namespace {

using test::AresBench;
using test::busyPath;
using test::engaged;
using test::kPeriod;
using test::PlacedJoints;

Matrix6d jacobian(const Pose& X_DT) {
    Matrix6d J_inv;
    EXPECT_TRUE(AresKinematics{}.inverseJacobian(X_DT, J_inv));
    return J_inv;
}

AresDeviceConfig heavyArm() {
    AresDeviceConfig config;
    config.weight = {.mass = 0.8, .centre_T = {0, 0, 0.03}};
    return config;
}

TEST(AresDevice, ShowsTheTruePoseAndItsMotion) {
    AresBench bench(busyPath(5e-5, 2));
    double worst_speed = 0, worst_spin = 0;
    for (int i = 0; i < 3000; ++i) {
        ASSERT_TRUE(bench.step(engaged()));
        const EmulatorState& truth = bench.emulator.state();
        EXPECT_LT((bench.reading.X_DT.position - truth.X_DT.position).norm(), 2e-5);
        EXPECT_LT(logRotation(bench.reading.X_DT.rotation * truth.X_DT.rotation.conjugate()).norm(), 5e-4);
        worst_speed = std::max(worst_speed, (bench.reading.v_DT - truth.v_DT).norm());
        worst_spin = std::max(worst_spin, (bench.reading.w_DT - truth.w_DT).norm());
    }
    // It is 4 ms late, at up to 2 m/s² and 30 rad/s², and counts encoder steps.
    EXPECT_LT(worst_speed, 0.02);
    EXPECT_LT(worst_spin, 0.3);
    EXPECT_TRUE(bench.reading.status & kStatusCalibrated);
}

TEST(AresDevice, TakesTheVelocitiesOfTheJointsWhereTheyGiveThem) {
    class Moving final : public JointDevice {
      public:
        bool hasClock() const noexcept override { return true; }
        bool waitForSample(int64_t) noexcept override { return true; }
        bool readJoints(double, JointReading& reading) noexcept override {
            reading.status = kStatusCalibrated;
            AresKinematics{}.inverse(Pose{}, reading.q);
            reading.q_dot.setConstant(0.1);
            return true;
        }
        void applyForces(const JointOrder&) noexcept override {}
    } joints;
    AresDevice device(joints, {});
    DeviceReading reading;
    EXPECT_TRUE(device.hasClock());
    EXPECT_TRUE(device.waitForSample(0));
    ASSERT_TRUE(device.read(kPeriod, reading));
    EXPECT_LT((reading.v_DT - Eigen::Vector3d(0, 0, 0.1)).norm(), 1e-12);
    EXPECT_LT(reading.w_DT.norm(), 1e-12);
}

TEST(AresDevice, TheHandFeelsTheOrderedWrench) {
    AresBench bench(OperatorPath({}, 5e-5));
    const DeviceOrder order = engaged({3, -2, 4}, {0.05, 0.1, -0.05});
    ASSERT_TRUE(bench.run(0.5, order));
    EXPECT_LT(
        (bench.device.actuatorForces() - actuatorForces(jacobian(bench.reading.X_DT), order.wrench_hand_D))
            .norm(),
        1e-6);
    EXPECT_EQ(bench.device.wrenchShare(), 1);
    ASSERT_TRUE(bench.reading.has_applied);
    EXPECT_LT((bench.reading.applied_D.force - order.wrench_hand_D.force).norm(), 0.01);
    EXPECT_LT((bench.reading.applied_D.torque - order.wrench_hand_D.torque).norm(), 1e-3);
}

TEST(AresDevice, WhatIsAppliedAnswersTheShareThatTheMotorsWereToldToGive) {
    AresDeviceConfig weak;
    weak.max_actuator_force = 1;
    AresBench bench(OperatorPath({}, 5e-5), weak);
    const DeviceOrder order = engaged({0, 0, 10});
    ASSERT_TRUE(bench.run(0.5, order));
    EXPECT_NEAR(bench.device.wrenchShare(), 0.6, 0.01);  // six motors that push straight up
    ASSERT_TRUE(bench.reading.has_applied);
    EXPECT_NEAR(bench.reading.applied_share, bench.device.wrenchShare(), 1e-3);
    EXPECT_LT(
        (bench.reading.applied_D.force - bench.reading.applied_share * order.wrench_hand_D.force).norm(),
        0.02);
    ASSERT_TRUE(bench.run(0.1, {}));  // not wanted: nothing may come
    ASSERT_TRUE(bench.reading.has_applied);
    EXPECT_EQ(bench.reading.applied_share, 0);
}

TEST(AresDevice, HoldsTheWeightWheneverItIsPoweredAndKeepsItOutOfWhatIsApplied) {
    AresBench bench(OperatorPath({}, 5e-5), heavyArm());
    const Vector6d holding = actuatorForces(jacobian({}), holdingWrench(heavyArm().weight, {}));
    DeviceOrder order;
    ASSERT_TRUE(bench.step(order));
    EXPECT_EQ(bench.device.actuatorForces(), Vector6d::Zero());  // not wanted
    order.is_wanted = true;
    ASSERT_TRUE(bench.step(order));
    EXPECT_LT((bench.device.actuatorForces() - holding).norm(), 0.02);
    EXPECT_FALSE(bench.joints.ordered.is_engaged);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.step(order));
    EXPECT_LT(bench.reading.applied_D.force.norm(), 0.1);
}

TEST(AresDevice, NeverLetsAHeavyArmFallForAWrenchThatIsTooLarge) {
    PlacedJoints joints;
    ASSERT_TRUE(joints.place({}));
    AresDevice device(joints, heavyArm());
    DeviceReading reading;
    ASSERT_TRUE(device.read(kPeriod, reading));
    const DeviceOrder order = engaged({0, 400, -300});
    device.write(order);
    EXPECT_LE(joints.ordered.forces.cwiseAbs().maxCoeff(), 50);
    EXPECT_GT(device.wrenchShare(), 0);
    EXPECT_LT(device.wrenchShare(), 1);
    const Wrench holding = holdingWrench(heavyArm().weight, {});
    const Wrench felt = wrenchOf(jacobian({}), joints.ordered.forces);
    const Eigen::Vector3d left = felt.force - holding.force;
    EXPECT_LT((left - device.wrenchShare() * order.wrench_hand_D.force).norm(), 1e-9);
    EXPECT_LT((felt.torque - holding.torque).norm(), 1e-9);
}

TEST(AresDevice, HoldsTheLastWeightWhileAReadingIsRefused) {
    AresBench bench(OperatorPath({}, 5e-5), heavyArm());
    ASSERT_TRUE(bench.run(0.05, engaged({1, 0, 0})));
    bench.joints.offset[3] = 10e-3;
    ASSERT_FALSE(bench.step(engaged({1, 0, 0})));
    const Vector6d holding = actuatorForces(jacobian({}), holdingWrench(heavyArm().weight, {}));
    EXPECT_LT((bench.joints.ordered.forces - holding).norm(), 0.1);  // and nothing of the wrench
}

TEST(AresDevice, AWrenchThatIsNotANumberMakesNoForceAndAFault) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        for (const bool is_engaged : {false, true}) {
            AresBench bench(OperatorPath({}, 5e-5), heavyArm());
            DeviceOrder order = engaged({0, bad, 0});
            order.is_engaged = is_engaged;
            ASSERT_TRUE(bench.step(order));
            EXPECT_EQ(bench.joints.ordered.forces, Vector6d::Zero());
            bench.step(engaged());
            EXPECT_EQ(bench.reading.fault, StopCause::kDeviceFault);
            EXPECT_EQ(bench.reading.fault_code, kAresNotFinite);
            bench.step(engaged());
            EXPECT_EQ(bench.reading.fault, StopCause::kNone);
        }
    }
}

TEST(AresDevice, BeforeCalibrationItRestsWhereItWouldStartAndGivesNoForce) {
    AresBench bench(OperatorPath({}, 5e-5), heavyArm());
    bench.joints.clear_status = kStatusCalibrated;
    bench.joints.offset.setConstant(0.02);
    for (int i = 0; i < 10; ++i) {
        EXPECT_TRUE(bench.step(engaged({1, 2, 3})));
        EXPECT_FALSE(bench.reading.status & kStatusCalibrated);
        EXPECT_TRUE(bench.reading.status & kStatusPowered);
        EXPECT_LT(bench.reading.X_DT.position.norm(), 1e-4);  // the offset lifts it by 20 mm
        EXPECT_EQ(bench.joints.ordered.forces, Vector6d::Zero());
    }
    bench.joints.clear_status = 0;
    bench.joints.offset.setZero();
    EXPECT_TRUE(bench.step(engaged()));
    EXPECT_TRUE(bench.reading.status & kStatusCalibrated);
}

TEST(AresDevice, RefusesPosesOutsideTheWorkspaceAndComesBack) {
    PlacedJoints joints;
    AresDevice device(joints, {});
    DeviceReading reading;
    const double end = AresKinematics{}.geometry().stroke / 2;
    const auto readAt = [&](double z) {
        EXPECT_TRUE(joints.place({{0, 0, z}, Eigen::Quaterniond::Identity()}));
        return device.read(0.05, reading);
    };
    EXPECT_TRUE(readAt(0));
    EXPECT_TRUE(readAt(end + 0.5e-3));
    EXPECT_FALSE(readAt(end + 2e-3));
    EXPECT_EQ(reading.fault, StopCause::kImplausiblePose);
    EXPECT_TRUE(reading.status & kStatusCalibrated);  // the encoders are sound
    EXPECT_TRUE(readAt(end - 1e-3));
}

Pose partOfTheWay(const Pose& X_DT, double s) {
    return {s * X_DT.position, Eigen::Quaterniond::Identity().slerp(s, X_DT.rotation)};
}

// Returns a pose that is all but singular, and that a straight way through stroke, lean and turn leads to.
Pose singularPose() {
    const AresKinematics kinematics;
    std::mt19937 random(4);
    for (int i = 0; i < 100'000; ++i) {
        const Pose far{0.05 * test::randomVector(random), expRotation(1.3 * test::randomDirection(random))};
        for (double s = 0.01; s <= 1; s += 0.01) {
            const Pose X_DT = partOfTheWay(far, s);
            if (kinematics.workspaceFaults(X_DT) != kWorkspaceOk) break;
            if (singularityIndex(jacobian(X_DT)) < 0.5 * kLostSingularityIndex) return X_DT;
        }
    }
    ADD_FAILURE() << "no way leads to a singularity";
    return {};
}

// Near a singularity a reading is refused; and when the platform has been too near, it may have gone over
// into another assembly, so that nothing is believed until a reset.
TEST(AresDevice, RefusesSingularPosesAndForgetsTheAssemblyBeyondThem) {
    PlacedJoints joints;
    AresDevice device(joints, {});
    DeviceReading reading;
    const Pose singular = singularPose();
    const auto readAt = [&](double s) {
        EXPECT_TRUE(joints.place(partOfTheWay(singular, s)));
        return device.read(0.05, reading);
    };
    for (int i = 0; i <= 1000; ++i) {
        const bool is_believed = readAt(1e-3 * i);
        const double index = singularityIndex(jacobian(partOfTheWay(singular, 1e-3 * i)));
        ASSERT_EQ(is_believed, index >= kMinSingularityIndex) << index;
        EXPECT_EQ(reading.fault, is_believed ? StopCause::kNone : StopCause::kSingularity);
    }
    for (int i = 1000; i >= 0; --i) ASSERT_FALSE(readAt(1e-3 * i));
    EXPECT_FALSE(reading.status & kStatusCalibrated);
    DeviceOrder reset;
    reset.reset = true;
    device.write(reset);
    EXPECT_TRUE(readAt(0));
}

TEST(AresDevice, ASoftWallHoldsTheHandBeforeTheEndOfTheStrokeAndIsCalm) {
    const double end = AresKinematics{}.geometry().stroke / 2;
    // The hand wants to go 10 mm beyond the stop, with 6 N.
    const OperatorPath path({{0, {}, 0}, {1, {{0, 0, end + 0.010}, Eigen::Quaterniond::Identity()}, 0}});
    AresDeviceConfig config;
    config.guard.has_frozen_check = false;  // this hand does not tremble
    config.guard.stuck_travel = StuckCheck::kSmoothTravel;
    AresBench bench(path, config);
    ASSERT_TRUE(bench.run(2.5, engaged()));
    EXPECT_TRUE(bench.device.touchesWall());
    double lowest = 1, highest = 0;
    for (int i = 0; i < 500; ++i) {
        ASSERT_TRUE(bench.step(engaged()));
        EXPECT_FALSE(bench.emulator.state().at_stop);
        lowest = std::min(lowest, bench.emulator.state().X_DT.position.z());
        highest = std::max(highest, bench.emulator.state().X_DT.position.z());
    }
    EXPECT_LT(highest, end - 0.5e-3);
    EXPECT_GT(lowest, end - 6e-3);
    EXPECT_LT(highest - lowest, 20e-6);                    // no buzz
    EXPECT_LT(bench.reading.applied_D.force.norm(), 0.3);  // nothing was ordered
}

TEST(AresDevice, SoftWallsComeAndGoWithTheEngagement) {
    PlacedJoints joints;
    ASSERT_TRUE(joints.place(
        {{0, 0, AresKinematics{}.geometry().stroke / 2 - 1e-3}, Eigen::Quaterniond::Identity()}));
    AresDevice device(joints, {});
    DeviceReading reading;
    double last = 0;
    const auto forceAfter = [&](const DeviceOrder& order, double largest_change) {
        EXPECT_TRUE(device.read(kPeriod, reading));
        device.write(order);
        const double now = -joints.ordered.forces[0];
        EXPECT_LE(std::abs(now - last), largest_change);
        return last = now;
    };
    DeviceOrder ready;
    ready.is_wanted = true;
    EXPECT_EQ(forceAfter(ready, 0), 0);
    for (int i = 0; i < 310; ++i) forceAfter(engaged(), 0.03);
    EXPECT_GT(last, 3);
    for (int i = 0; i < 60; ++i) forceAfter(ready, 0.2);
    EXPECT_EQ(last, 0);
}

TEST(AresDevice, SaysWhatItCanDo) {
    PlacedJoints joints;
    AresDeviceConfig config;
    config.max_force = 40;
    config.max_torque = 0.8;
    const DeviceCapabilities real = AresDevice(joints, config).capabilities();
    EXPECT_TRUE(isPlausible(real));
    EXPECT_EQ(std::string(real.name), "ARES (placeholder geometry)");
    EXPECT_EQ(real.kind, uint32_t(DeviceKind::kAres));
    EXPECT_EQ(real.abilities, kAbilityForce | kAbilityTorque | kAbilityOrientation);
    EXPECT_EQ(real.max_force, 40);
    EXPECT_EQ(real.max_torque, 0.8);
    EXPECT_NEAR(real.workspace_radius, 0.033, 0.002);
    config.is_simulated = config.has_enabling_switch = true;
    const DeviceCapabilities emulated = AresDevice(joints, config).capabilities();
    EXPECT_EQ(std::string(emulated.name), "ARES emulator (placeholder geometry)");
    EXPECT_TRUE(emulated.abilities & kAbilitySimulated);
    EXPECT_TRUE(emulated.abilities & kAbilityEnablingSwitch);
}

}  // namespace
}  // namespace bonemill
