#include <gtest/gtest.h>

#include <complex>

#include "tests/support/contact_set.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kWindow = 1000;  // ticks: bins of 1 Hz

struct VibrationTest : testing::Test {
    VibrationTest() { bench.tick.X_VT_start.rotation = expRotation({0.4, -0.2, 0.9}); }

    // The burr is pressed with this force, at turns_per_s.
    void run(int ticks, double force, double turns_per_s) {
        test::ContactSet contacts;
        if (force > 0) contacts.add({0, -1e-3, 0}, {0, 1, 0}, force);
        contacts.giveTo(bench.tick);
        bench.tick.spin_speed = 2 * M_PI * turns_per_s;
        for (int n = 0; n < ticks; ++n) {
            Wrench wrench;
            vibration->begin(bench.tick);
            vibration->addToHand(bench.tick, wrench);
            felt.push_back(wrench);
        }
    }
    double sample(size_t n) const {
        return felt[n].force.dot(bench.tick.X_VT_start.rotation * Vector3d::UnitX());
    }
    // Returns the amplitude, N, that the last kWindow samples have at this frequency, Hz.
    double amplitudeAt(int hz) const {
        std::complex<double> sum = 0;
        for (int n = 0; n < kWindow; ++n)
            sum += sample(felt.size() - kWindow + size_t(n)) * std::polar(1.0, -2 * M_PI * hz * n / kWindow);
        return 2 * std::abs(sum) / kWindow;
    }

    test::BurrTick bench;
    std::unique_ptr<HapticEffect> vibration = test::effectOf(test::kBurrVibration);
    std::vector<Wrench> felt;
};

TEST_F(VibrationTest, HasOneFrequencyAndTheLoadsAmplitude) {
    for (const auto& [turns, hz] : {std::pair{170.0, 170}, {60.0, 60}, {50.0, 50}, {667.0, 400}}) {
        felt.clear();
        run(300 + kWindow, 4, turns);
        const double wanted = 0.05 * 0.5 * 4;
        EXPECT_NEAR(amplitudeAt(hz), wanted, 1e-6) << hz;
        for (int other = 1; other < kWindow / 2; ++other)
            if (other != hz) {
                ASSERT_LT(amplitudeAt(other), 1e-6) << other << " beside " << hz;
            }
    }
}

TEST_F(VibrationTest, IsAtRightAnglesToTheAxisAndWithoutTorque) {
    run(100, 4, 170);
    for (const Wrench& wrench : felt) {
        EXPECT_NEAR(wrench.force.dot(bench.tick.axis()), 0, 1e-15);
        EXPECT_EQ(wrench.torque.norm(), 0);
    }
}

TEST_F(VibrationTest, GrowsNoLargerThanItsLimit) {
    run(300 + kWindow, 100, 170);
    EXPECT_NEAR(amplitudeAt(170), test::kBurrVibration.max_amplitude, 1e-6);
}

TEST_F(VibrationTest, IsLessWithDiamondAndBelowTheSlowestTurns) {
    bench.tool.burr.grit = BurrGrit::kDiamond;
    run(300 + kWindow, 4, 170);
    EXPECT_NEAR(amplitudeAt(170), 0.3 * 0.1, 1e-6);
    run(300 + kWindow, 4, 25);
    EXPECT_NEAR(amplitudeAt(50), 0.5 * 0.3 * 0.1, 1e-6);
}

TEST_F(VibrationTest, IsExactlyNothingInTheAirAndWithoutSpin) {
    run(300, 0, 170);
    for (const Wrench& wrench : felt) ASSERT_EQ(wrench.force.norm(), 0);
    for (const auto& [force, turns] : {std::pair{0.0, 170.0}, {4.0, 0.0}}) {
        run(300, 4, 170);
        EXPECT_GT(felt.back().force.norm() + felt[felt.size() - 2].force.norm(), 0.01);
        run(300, force, turns);
        EXPECT_EQ(felt.back().force.norm(), 0);
    }
}

// However speed and load jump, no step is longer than the highest frequency at full amplitude makes it.
TEST_F(VibrationTest, PhaseAndAmplitudeHaveNoJumps) {
    for (int n = 0; n < 40; ++n) run(37, n % 3 ? 40 : 0, 50 + 33.3 * (n % 11));
    const double longest = 2 * std::sin(M_PI * BurrVibrationConfig::kHighest * bench.tick.dt);
    const double ramp = bench.tick.dt / BurrVibrationConfig::kSmoothing;
    for (size_t n = 1; n < felt.size(); ++n)
        ASSERT_LE(std::abs(sample(n) - sample(n - 1)), (longest + ramp) * test::kBurrVibration.max_amplitude);
}

TEST(Vibration, StaysBelowWhatTheLoopRateCarries) {
    EXPECT_DOUBLE_EQ(BurrVibrationConfig::frequency(1e5, 1e-3), 400);
    EXPECT_DOUBLE_EQ(BurrVibrationConfig::frequency(-1e5, 2e-3), 200);
    EXPECT_DOUBLE_EQ(BurrVibrationConfig::frequency(0, 1e-3), 50);
    EXPECT_DOUBLE_EQ(BurrVibrationConfig::frequency(2 * M_PI * 123, 1e-3), 123);
}

}  // namespace
}  // namespace bonemill
