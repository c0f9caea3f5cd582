#include <gtest/gtest.h>

#include "haptic_server/core/effects/burr_speed.h"
#include "tests/support/contact_set.h"
#include "tests/support/eigenvalues.h"
#include "tests/support/energy_check.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr CuttingForceConfig kPrompt{.slow_speed = 0.01, .smoothing_time = 0};

struct CuttingForceTest : testing::Test {
    CuttingForceTest() {
        bench.tick.X_VT_start = {{1e-3, 2e-3, 3e-3}, expRotation({0.3, -0.7, 1.1})};
        bench.tick.X_VT = bench.tick.X_VT_start;
    }
    EnergyTerm feltAfterBegin() {
        contacts.giveTo(bench.tick);
        cutting->begin(bench.tick);
        cutting->finish(bench.tick);
        return cutting->energy(bench.tick, bench.tick.X_VT);
    }

    std::mt19937 random{7};
    test::BurrTick bench;
    test::ContactSet contacts;
    std::unique_ptr<HapticEffect> cutting = test::effectOf(kPrompt);
};

TEST_F(CuttingForceTest, PullsAgainstTheSpinWithFrictionTimesForce) {
    const Vector3d axis = bench.tick.axis(), out = axis.unitOrthogonal();
    contacts.add(bench.tool.burr.radius * out, -out, 4);
    const Wrench felt = feltAfterBegin().wrench;
    const double v = bench.tool.burr.speed * bench.tool.burr.radius;
    EXPECT_LT((felt.force + 0.5 * 4 * v / std::hypot(v, kPrompt.slow_speed) * axis.cross(out)).norm(), 1e-6);
    EXPECT_NEAR(bench.tick.record.axis_torque, 0.5 * 4 * 1e-3, 1e-5);
}

// M Ω = μ_c Σ F v · v/√(v² + v_ε²) holds for any contacts; with v_ε out of the way it is the power of
// friction.
TEST_F(CuttingForceTest, AxisTorqueTimesSpinIsThePowerOfFriction) {
    const Vector3d axis = bench.tick.axis();
    for (const double spin : {30.0, 4000.0, -4000.0}) {
        contacts = {};
        contacts.addOnBall(random, bench.tool.burr.radius, 100);
        bench.tick.spin_speed = spin;
        const Wrench felt = feltAfterBegin().wrench;
        double power = 0, with_slow = 0;
        for (size_t n = 0; n < contacts.contacts.size(); ++n) {
            const Vector3d r = contacts.contacts[n].r_V.cast<double>();
            const double v = std::abs(spin) *
                             std::hypot(axis.cross(r).norm(), 2.0 / 3 * std::sqrt(contacts.areas[n] / M_PI));
            power += 0.5 * contacts.contacts[n].force * v;
            with_slow += 0.5 * contacts.contacts[n].force * v * v / std::hypot(v, kPrompt.slow_speed);
        }
        EXPECT_NEAR(-axis.dot(felt.torque) * spin, with_slow, 1e-5 * power);
        EXPECT_NEAR(bench.tick.record.axis_torque * std::abs(spin), with_slow, 1e-5 * power);
        EXPECT_NEAR(0.5 * bench.tick.burr_load.moment * std::abs(spin), power, 1e-5 * power);
    }
    EXPECT_LT(kPrompt.slow_speed, 0.01 * 4000 * bench.tool.burr.radius);  // what "out of the way" means
}

TEST_F(CuttingForceTest, IsMinusTheGradientOfItsEnergyForFiniteStepsToo) {
    contacts.addOnBall(random, bench.tool.burr.radius, 30);
    bench.tick.velocity_V = {0.02, -0.05, 0.03};
    bench.tick.angular_velocity_V = {1, 2, -3};
    feltAfterBegin();
    const auto energy = [&](const Pose& pose) { return cutting->energy(bench.tick, pose); };
    for (const double turn : {1e-3, 0.1, 1.0}) {
        const Pose pose =
            bench.tick.X_VT_start.incremented({1e-4, -2e-4, 1e-4}, turn * Vector3d(0.4, 0.8, -0.5));
        const double scale = energy(pose).wrench.force.norm() + energy(pose).wrench.torque.norm() / 1e-3;
        test::expectWrenchIsGradient(energy, pose, 1e-6, 1e-3, 1e-5 * scale);
    }
}

TEST_F(CuttingForceTest, HoldsBackTheToolsOwnMotion) {
    contacts.addOnBall(random, bench.tool.burr.radius, 30);
    feltAfterBegin();
    const auto energy = [&](const Pose& pose) { return cutting->energy(bench.tick, pose); };
    const EnergyTerm at_start = energy(bench.tick.X_VT_start);
    const Vector6d modes = test::eigenvaluesOf(at_start.stiffness);
    EXPECT_GE(modes[0], -1e-12 * modes[5]);
    const Vector3d step(1e-5, 0, 0);
    const Vector3d change = energy(bench.tick.X_VT_start.incremented(step, Vector3d::Zero())).wrench.force -
                            at_start.wrench.force;
    EXPECT_LT(change.dot(step), 0);
}

// What it passes on is the motor's torque, whichever way that turns, and all of it whatever touches where.
TEST_F(CuttingForceTest, AStandingBurrPassesTheMotorsTorqueOn) {
    contacts.addOnBall(random, bench.tool.burr.radius, 100);
    bench.tick.spin_speed = 0;
    for (const double load : {2e-3, -2e-3}) {
        bench.tick.axis_load = load;
        const Wrench felt = feltAfterBegin().wrench;
        EXPECT_NEAR(bench.tick.axis().dot(felt.torque), -load, 1e-6 * std::abs(load));
        EXPECT_NEAR(bench.tick.record.axis_torque, 2e-3, 1e-8);
    }
}

TEST_F(CuttingForceTest, IsNothingForAStandingBurrAndOffTheBurr) {
    contacts.addOnBall(random, bench.tool.burr.radius, 10);
    bench.tick.spin_speed = 0;
    EXPECT_EQ(feltAfterBegin().wrench.force.norm(), 0);
    EXPECT_EQ(bench.tick.record.axis_torque, 0);
    bench.tick.spin_speed = bench.tool.burr.speed;
    std::fill(contacts.on_burr.begin(), contacts.on_burr.end(), uint8_t(0));
    EXPECT_EQ(feltAfterBegin().wrench.force.norm(), 0);
    EXPECT_EQ(bench.tick.burr_load.force, 0);
}

// The pole of a burr does not move: what is left there is the patch's own turning.
TEST_F(CuttingForceTest, PoleTurnsButDoesNotPull) {
    const Vector3d axis = bench.tick.axis();
    const double area = 1e-8, rho = 2.0 / 3 * std::sqrt(area / M_PI);
    contacts.add(-bench.tool.burr.radius * axis, axis, 2, area);
    const Wrench felt = feltAfterBegin().wrench;
    const double v = bench.tool.burr.speed * rho;
    EXPECT_LT(felt.force.norm(), 1e-4);
    EXPECT_NEAR(-felt.torque.dot(axis), 0.5 * 2 * rho * v / std::hypot(v, kPrompt.slow_speed), 1e-8);
}

// A drill of 2.5 mm at 1000/min, whose rim has 131 mm/s.
struct SlowDrillTest : CuttingForceTest {
    static constexpr double kRim = 1.25e-3, kSpin = 1000 * 2 * M_PI / 60, kPressure = 2e6;

    SlowDrillTest() { bench.tick.spin_speed = kSpin; }
    // Bone presses on the band of a body of revolution between two circles (m, along the axis and off it), on
    // half of it with the cosine of the angle or all around evenly. Returns ∫ p dA and ∫ μ p ρ dA.
    struct Load {
        double force = 0, moment = 0;
    };
    Load press(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool is_from_one_side) {
        constexpr int kAlong = 40, kAround = 64;
        const Vector3d axis = bench.tick.axis(), out = axis.unitOrthogonal(), side = axis.cross(out);
        const Eigen::Vector2d way = to - from;
        Load load;
        for (int i = 0; i < kAlong; ++i)
            for (int j = 0; j < kAround; ++j) {
                const Eigen::Vector2d at = from + (i + 0.5) / kAlong * way;
                const double angle = 2 * M_PI * (j + 0.5) / kAround;
                const Vector3d radial = std::cos(angle) * out + std::sin(angle) * side;
                const double area = way.norm() / kAlong * 2 * M_PI * at.y() / kAround;
                const double share = is_from_one_side ? std::max(0.0, std::cos(angle)) : 1;
                const Vector3d push = (way.y() * axis - way.x() * radial).normalized();
                const double force = share * kPressure * area;
                if (force > 0) contacts.add(at.x() * axis + at.y() * radial, push, force, area);
                load.force += force;
                load.moment += 0.5 * force * at.y();
            }
        return load;
    }
    double torqueAboutAxis() { return -bench.tick.axis().dot(feltAfterBegin().wrench.torque); }
};

// Its flutes cut along the whole side: M = ∫ μ p R dA, for p = p₀ cos over half of it 2 μ p₀ R² L.
TEST_F(SlowDrillTest, TheSideOfACylinderCutsAtItsRadius) {
    constexpr double kLength = 4e-3;
    const Load load = press({0, kRim}, {kLength, kRim}, true);
    const double expected = 0.5 * kPressure * 2 * kRim * kRim * kLength;
    EXPECT_NEAR(load.moment / expected, 1, 1e-3);
    EXPECT_NEAR(torqueAboutAxis() / expected, 1, 0.01);
    // p₀ cos pushes with π/4 of p₀ over the section, and drags across that with μ times as much.
    const Wrench felt = feltAfterBegin().wrench;
    const Vector3d axis = bench.tick.axis(), across = axis.cross(axis.unitOrthogonal());
    EXPECT_NEAR(-felt.force.dot(across) / (0.5 * M_PI / 2 * kPressure * kRim * kLength), 1, 0.01);
}

// M = ∫ μ p ρ dA = 2π/3 μ p (R³ − r³)/sin α, α the cone's angle to its axis.
TEST_F(SlowDrillTest, AConeCutsAtTheRadiusOfEachPlace) {
    constexpr double kTip = 0.4e-3, kLength = 3e-3;
    press({0, kTip}, {kLength, kRim}, false);
    const double slope = (kRim - kTip) / std::hypot(kRim - kTip, kLength);
    const double expected = 0.5 * kPressure * 2 * M_PI / 3 * (std::pow(kRim, 3) - std::pow(kTip, 3)) / slope;
    EXPECT_NEAR(torqueAboutAxis() / expected, 1, 0.02);
}

// A flat end cuts with two thirds of its radius, and not at all where its axis is.
TEST_F(SlowDrillTest, AFlatEndCutsLittleAtItsMiddle) {
    const Load whole = press({0, 0}, {0, kRim}, false);
    EXPECT_NEAR(torqueAboutAxis() / (0.5 * whole.force * 2 / 3 * kRim), 1, 0.02);
    contacts = {};
    const Load middle = press({0, 0}, {0, kRim / 10}, false);
    EXPECT_NEAR(middle.force / whole.force, 0.01, 1e-4);
    EXPECT_LT(torqueAboutAxis(), 2e-3 * 0.5 * whole.force * 2 / 3 * kRim);
}

TEST_F(CuttingForceTest, FollowsAChangeOfLoadWithItsTimeConstant) {
    constexpr double kTau = 20e-3;
    const auto smooth = test::effectOf(CuttingForceConfig{.slow_speed = 0.01, .smoothing_time = kTau});
    const Vector3d out = bench.tick.axis().unitOrthogonal();
    contacts.add(bench.tool.burr.radius * out, -out, 4);
    contacts.giveTo(bench.tick);
    for (int n = 0; n < 20; ++n) smooth->begin(bench.tick);
    smooth->finish(bench.tick);
    // Backward Euler gives 1 − (1 + dt/τ)^(−n).
    const double full = 0.5 * 4 * 1e-3, share = 1 - std::pow(1 + bench.tick.dt / kTau, -20);
    EXPECT_NEAR(bench.tick.record.axis_torque, share * full, 0.01 * full);
    smooth->restart(Restart::kOtherTool);
    smooth->finish(bench.tick);
    EXPECT_EQ(bench.tick.record.axis_torque, 0);
}

}  // namespace
}  // namespace bonemill
