#include <gtest/gtest.h>

#include "tests/support/contact_set.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

constexpr double kFullSpeed = 4000;  // rad/s

double speedAfter(const SpindleConfig& config, double seconds, double dt, double load = 0, double start = 0,
                  double wanted = kFullSpeed) {
    double speed = start;
    for (long n = 0; n < std::lround(seconds / dt); ++n) speed = config.speedAfter(speed, wanted, load, dt);
    return speed;
}

// Without drag it runs up at the motor's limit to where the droop takes over, then exponentially.
double runUp(const SpindleConfig& c, double t) {
    const double knee = kFullSpeed - c.max_torque / c.droop, t_knee = c.inertia * knee / c.max_torque;
    if (t < t_knee) return c.max_torque / c.inertia * t;
    return kFullSpeed - c.max_torque / c.droop * std::exp(-(t - t_knee) * c.droop / c.inertia);
}

TEST(Spindle, RunsUpAsTheClosedFormSays) {
    SpindleConfig config = test::kSpindle;
    config.drag = 0;
    for (const double t : {0.02, 0.05, 0.085, 0.1, 0.11, 0.15}) {
        EXPECT_NEAR(speedAfter(config, t, 1e-3), runUp(config, t), 0.005 * kFullSpeed) << t;
        EXPECT_NEAR(speedAfter(config, t, 1e-5), runUp(config, t), 0.0002 * kFullSpeed) << t;
    }
}

TEST(Spindle, DroopsUnderLoad) {
    const SpindleConfig config = test::kSpindle;
    for (const double load : {0.0, 2e-3, 10e-3})
        EXPECT_NEAR(speedAfter(config, 2, 1e-3, load),
                    (config.droop * kFullSpeed - load) / (config.droop + config.drag), 1e-6 * kFullSpeed);
}

TEST(Spindle, StandsExactlyStillAboveTheStallTorqueAndOnlyThere) {
    const SpindleConfig config = test::kSpindle;
    EXPECT_EQ(speedAfter(config, 3, 1e-3, 1.1 * config.max_torque, kFullSpeed), 0);
    EXPECT_EQ(speedAfter(config, 3, 1e-3, 1.001 * config.max_torque), 0);
    EXPECT_GT(speedAfter(config, 3, 1e-3, 0.9 * config.max_torque), 0.5 * kFullSpeed);
}

TEST(Spindle, StopsInTheTimeThatTheMissingTorqueTakes) {
    SpindleConfig config = test::kSpindle;
    config.drag = 0;
    config.droop = 1;  // at its limit all the while
    const double load = 2 * config.max_torque, stop = config.inertia * kFullSpeed / config.max_torque;
    EXPECT_GT(speedAfter(config, stop - 2e-3, 1e-3, load, kFullSpeed), 0);
    EXPECT_EQ(speedAfter(config, stop + 2e-3, 1e-3, load, kFullSpeed), 0);
}

TEST(Spindle, LoadNeverDrivesNorReverses) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const SpindleConfig config = test::kSpindle;
    for (int n = 0; n < 100'000; ++n) {
        const double speed = kFullSpeed * uniform(random), wanted = n % 3 ? kFullSpeed * uniform(random) : 0;
        const double load = 5 * config.max_torque * std::abs(uniform(random));
        const double free = config.speedAfter(speed, wanted, 0, 1e-3);
        const double loaded = config.speedAfter(speed, wanted, load, 1e-3);
        ASSERT_LE(std::abs(loaded), std::abs(free) * (1 + 1e-12));
        ASSERT_GE(loaded * free, 0);
    }
}

TEST(Spindle, TakesAnyStiffnessOfTheMotor) {
    SpindleConfig config = test::kSpindle;
    config.droop = 1e3;
    double last = 0;
    for (int n = 0; n < 300; ++n) {
        const double speed = config.speedAfter(last, kFullSpeed, 0, 1e-3);
        ASSERT_GE(speed, last * (1 - 1e-12));
        ASSERT_LE(speed, kFullSpeed);
        last = speed;
    }
    EXPECT_NEAR(last, kFullSpeed, 1e-3);
}

TEST(Spindle, TurnsBackwardsForANegativeSpeed) {
    const SpindleConfig config = test::kSpindle;
    EXPECT_DOUBLE_EQ(speedAfter(config, 0.1, 1e-3, 1e-3, 0, -kFullSpeed),
                     -speedAfter(config, 0.1, 1e-3, 1e-3));
}

// The burr is pressed sidewards at its equator: M = μ_c F R.
struct PressedSpindle : testing::Test {
    void run(double seconds, double force, bool pedal) {
        test::ContactSet contacts;
        if (force > 0)
            contacts.add(bench.tool.burr.radius * Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), force);
        contacts.giveTo(bench.tick);
        bench.tick.is_pedal_down = pedal;
        for (int n = 0; n < int(seconds / bench.tick.dt); ++n) {
            spindle->begin(bench.tick);
            bench.tick.record = {};
            spindle->finish(bench.tick);
            was_stalled |= isStalled();
        }
        bench.tick.contacts = {};
    }
    bool isStalled() const { return bench.tick.record.events & kEventSpindleStalled; }

    test::BurrTick bench;
    std::unique_ptr<HapticEffect> spindle = test::effectOf(test::kSpindle);
    bool was_stalled = false;
};

TEST_F(PressedSpindle, StallsSaysSoAndStartsAgain) {
    const Burr& burr = bench.tool.burr;
    const double stall_force = test::kSpindle.max_torque / (burr.friction * burr.radius);
    run(0.5, 0, true);
    run(0.5, 0.8 * stall_force, true);
    EXPECT_FALSE(was_stalled);
    EXPECT_GT(bench.tick.spin_speed, 0.8 * burr.speed);
    EXPECT_NEAR(bench.tick.record.axis_torque, 0.8 * test::kSpindle.max_torque, 1e-6);
    run(1, 1.1 * stall_force, true);
    EXPECT_TRUE(isStalled());
    EXPECT_EQ(bench.tick.spin_speed, 0);
    EXPECT_NEAR(bench.tick.record.axis_torque, test::kSpindle.max_torque, 1e-6);
    EXPECT_NEAR(bench.tick.axis_load, test::kSpindle.max_torque, 1e-6);
    run(0.5, 0.8 * stall_force, true);
    EXPECT_FALSE(isStalled());
    EXPECT_GT(bench.tick.spin_speed, 0.8 * burr.speed);
}

TEST_F(PressedSpindle, IsNotStalledWhileItRunsUpOrStands) {
    run(0.5, 0, true);
    run(1, 5, false);
    EXPECT_EQ(bench.tick.spin_speed, 0);
    run(0.5, 0, true);
    EXPECT_FALSE(was_stalled);
}

// This holds however slowly it runs up.
TEST_F(PressedSpindle, NeverStallsInTheAir) {
    const auto slow =
        test::effectOf(SpindleConfig{.inertia = 5e-6, .max_torque = 0.02, .droop = 1e-7, .drag = 1e-6});
    bench.tick.is_pedal_down = true;
    for (int n = 0; n < 5000; ++n) {
        slow->begin(bench.tick);
        slow->finish(bench.tick);
        ASSERT_FALSE(isStalled());
    }
    EXPECT_LT(bench.tick.spin_speed, 0.1 * bench.tool.burr.speed);
}

TEST_F(PressedSpindle, BrakesToZeroInTheAir) {
    run(0.5, 0, true);
    run(0.5, 0, false);
    EXPECT_LT(std::abs(bench.tick.spin_speed), 1e-6 * bench.tool.burr.speed);
    EXPECT_EQ(bench.tick.axis_load, 0);
}

TEST_F(PressedSpindle, HoldsNothingWithThePedalUp) {
    run(0.5, 0, true);
    run(1, 5, false);
    EXPECT_EQ(bench.tick.spin_speed, 0);
    EXPECT_EQ(bench.tick.axis_load, 0);
}

TEST_F(PressedSpindle, AnotherToolStartsFromRest) {
    run(0.5, 0, true);
    spindle->restart(Restart::kOtherTool);
    run(2e-3, 0, true);
    EXPECT_LT(bench.tick.spin_speed, 0.03 * bench.tool.burr.speed);
}

}  // namespace
}  // namespace bonemill
