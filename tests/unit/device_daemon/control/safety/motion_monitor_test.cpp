#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "device_daemon/control/safety/safety_states.h"

namespace bonemill {
namespace {

constexpr double kWatchDt = 1e-3;

DeviceReading movingAt(const Eigen::Vector3d& v, const Eigen::Vector3d& w = Eigen::Vector3d::Zero()) {
    DeviceReading reading;
    reading.v_DT = v;
    reading.w_DT = w;
    return reading;
}

// Returns after how many s it names a cause, and which; a year when it names none in 10 s.
std::pair<double, StopCause> tripOf(MotionMonitor& watch, const DeviceReading& reading, const Wrench& given) {
    for (int i = 1; i <= 10000; ++i) {
        const StopCause cause = watch.check(reading, given, kWatchDt);
        if (cause != StopCause::kNone) return {i * kWatchDt, cause};
    }
    return {3e7, StopCause::kNone};
}

TEST(MotionMonitor, LetsTheHandMill) {
    MotionMonitor watch;
    // 20 N against a hand that gives way at 50 mm/s for ever is beyond what milling does.
    for (int i = 0; i < 60000; ++i) {
        const double t = i * kWatchDt;
        const DeviceReading reading =
            movingAt({0.1 * std::sin(20 * t), 0.2 * std::cos(7 * t), 0}, {0, 0, std::sin(9 * t)});
        ASSERT_EQ(watch.check(reading, {{0, 5 * std::sin(31 * t), 15}, {0, 0, 0.2}}, kWatchDt),
                  StopCause::kNone)
            << t;
    }
}

TEST(MotionMonitor, StopsAHandleThatFlies) {
    MotionMonitor watch;
    EXPECT_EQ(tripOf(watch, movingAt({2, 0, 0}), {}).second, StopCause::kSpeed);
    watch.restart();
    const auto [time, cause] = tripOf(watch, movingAt({0, 0, 0}, {0, 30, 0}), {});
    EXPECT_EQ(cause, StopCause::kSpeed);
    EXPECT_LE(time, MotionMonitor::kFastSamples * kWatchDt + 1e-12);
    watch.restart();
    EXPECT_EQ(tripOf(watch, movingAt({std::numeric_limits<double>::quiet_NaN(), 0, 0}), {}).second,
              StopCause::kSpeed);
    watch.restart();
    EXPECT_EQ(tripOf(watch, movingAt({0.9, 0, 0}), {}).second, StopCause::kNone);
}

TEST(MotionMonitor, ASpeedThatIsNoNumberBlindsThePowersWatchForNoLonger) {
    MotionMonitor watch;
    const Wrench given{{40, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(watch.check(movingAt({std::numeric_limits<double>::quiet_NaN(), 0, 0}), given, kWatchDt),
              StopCause::kNone);
    EXPECT_EQ(tripOf(watch, movingAt({0.9, 0, 0}), given).second, StopCause::kPower);
}

TEST(MotionMonitor, OneFastSampleAloneIsNoise) {
    MotionMonitor watch;
    for (int i = 0; i < 1000; ++i)
        EXPECT_EQ(watch.check(movingAt({i % 2 ? 5.0 : 0.0, 0, 0}), {}, kWatchDt), StopCause::kNone);
}

TEST(MotionMonitor, StopsMotorsThatDriveTheHand) {
    MotionMonitor watch({.max_power = 10});
    // 50 N at 0.5 m/s are 25 W: beyond 10 W after the time in which a filter of kPowerTime gets to 10/25.
    const auto [time, cause] = tripOf(watch, movingAt({0.5, 0, 0}), {{50, 0, 0}, {0, 0, 0}});
    EXPECT_EQ(cause, StopCause::kPower);
    EXPECT_NEAR(time, -MotionMonitor::kPowerTime * std::log(1 - 10.0 / 25), 1.5e-3);
    watch.restart();
    EXPECT_EQ(tripOf(watch, movingAt({-0.5, 0, 0}), {{50, 0, 0}, {0, 0, 0}}).second,
              StopCause::kNone);  // the hand works
}

TEST(MotionMonitor, StopsWhatGivesTooMuchEnergy) {
    MotionMonitor watch({.max_power = 10, .max_energy = 3});
    // 8 W are within the power; the energy goes to 8 J with kEnergyTime.
    const auto [time, cause] = tripOf(watch, movingAt({0.4, 0, 0}), {{20, 0, 0}, {0, 0, 0}});
    EXPECT_EQ(cause, StopCause::kEnergy);
    EXPECT_NEAR(time, -MotionMonitor::kEnergyTime * std::log(1 - 3.0 / 8), 5e-3);
    watch.restart();
    // Torque counts as well.
    EXPECT_EQ(tripOf(watch, movingAt({0, 0, 0}, {8, 0, 0}), {{}, {1, 0, 0}}).second, StopCause::kEnergy);
    watch.restart();
    // A spring that gives back what it got does not add up.
    for (int i = 0; i < 20000; ++i) {
        const double t = i * kWatchDt;
        ASSERT_EQ(watch.check(movingAt({0.3 * std::cos(20 * t), 0, 0}),
                              {{-15 * std::sin(20 * t), 0, 0}, {0, 0, 0}}, kWatchDt),
                  StopCause::kNone);
    }
}

TEST(MotionMonitor, StopsMotorsThatDoNotDoWhatTheyAreTold) {
    MotionMonitor watch({.max_force = 20});
    DeviceReading dead;
    dead.has_applied = true;
    const auto [time, cause] = tripOf(watch, dead, {{0, 0, 10}, {0, 0, 0}});
    EXPECT_EQ(cause, StopCause::kForceMismatch);
    EXPECT_LT(time, 0.1);
    watch.restart();
    DeviceReading runaway = dead;  // 20 N that nobody has ordered
    runaway.applied_D.force = {0, 20, 0};
    EXPECT_EQ(tripOf(watch, runaway, {}).second, StopCause::kForceMismatch);
    watch.restart();
    // An amplifier of 50 Hz and two ticks late, under a force that swings, is slow and not dead.
    Eigen::Vector3d applied = Eigen::Vector3d::Zero();
    double late[3] = {};
    for (int i = 0; i < 20000; ++i) {
        late[i % 3] = 10 * std::sin(2 * M_PI * 8 * i * kWatchDt);
        applied += 0.3 * (Eigen::Vector3d(0, 0, late[(i + 1) % 3]) - applied);
        DeviceReading slow = dead;
        slow.applied_D.force = applied;
        ASSERT_EQ(watch.check(slow, {{0, 0, late[i % 3]}, {0, 0, 0}}, kWatchDt), StopCause::kNone) << i;
    }
}

TEST(MotionMonitor, AMismatchIsOneAgainstWhatTheDeviceItselfHasOrdered) {
    MotionMonitor watch({.max_force = 20});
    const Wrench given{{0, 0, 20}, {0, 0, 0}};
    DeviceReading limited;  // its motors cannot give more than 8 N of it, and do
    limited.has_applied = true;
    limited.applied_share = 0.4;
    limited.applied_D.force = {0, 0, 8};
    EXPECT_EQ(tripOf(watch, limited, given).second, StopCause::kNone);
    watch.restart();
    limited.applied_D.force = {0, 0, 0};
    EXPECT_EQ(tripOf(watch, limited, given).second, StopCause::kForceMismatch);
    watch.restart();
    limited.applied_D.force = {0, 0, 20};
    EXPECT_EQ(tripOf(watch, limited, given).second, StopCause::kForceMismatch);
}

TEST(MotionMonitor, HotMotorsGetLessAndThenNothing) {
    EXPECT_EQ(MotionMonitor::warmShare(0), 1);
    EXPECT_EQ(MotionMonitor::warmShare(0.8), 1);
    EXPECT_NEAR(MotionMonitor::warmShare(0.9), 0.65, 1e-12);
    EXPECT_NEAR(MotionMonitor::warmShare(1.5), 0.3, 1e-12);
    MotionMonitor watch;
    DeviceReading hot;
    hot.load = 0.99;
    EXPECT_EQ(watch.check(hot, {}, kWatchDt), StopCause::kNone);
    hot.load = 1;
    EXPECT_EQ(watch.check(hot, {}, kWatchDt), StopCause::kOverTemperature);
}

}  // namespace
}  // namespace bonemill
