// Runs device loop, emulated device and simulated hand against a virtual wall, in simulated time with the one
// tick of delay of the real arrangement.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "device_daemon/ares/ares_device/ares_device.h"
#include "device_daemon/ares/driver/ares_emulator.h"
#include "device_daemon/control/device_loop/device_loop.h"

namespace bonemill {
namespace {

constexpr double kLoopPeriod = 1e-3;  // s
constexpr int64_t kPeriodNs = 1'000'000;
constexpr double kSoftWall = 1200;        // N/m, resists z < 0 of the handle
constexpr double kThesisCoupling = 3000;  // N/m: what a rigid bone feels like through k_t = 3 N/mm

DeviceLoopConfig withoutSwitch() {
    DeviceLoopConfig config;
    config.states.needs_enabling_switch = false;
    return config;
}

class ClosedLoop {
  public:
    explicit ClosedLoop(const OperatorPath& path)
        : emulator(AresKinematics{}, {}, {}, path), ares(emulator, {}), loop(ares, withoutSwitch()) {
        emulator.startScenario();
    }

    // In one period the server computes the answer to this period's sample; the device gets it in
    // the next one.
    void step(bool server_answers = true) {
        now_ns += kPeriodNs;
        DeviceSample sample;
        ASSERT_TRUE(loop.read(now_ns, kLoopPeriod, sample));
        loop.write(&command, now_ns);
        if (!server_answers) return;
        command = {};
        command.stamp_ns = now_ns;
        command.f_hand_D[2] = sample.p_DT[2] < 0 ? -wall_stiffness * sample.p_DT[2] : 0;
        if (force_override) std::copy_n(force_override, 3, command.f_hand_D);
    }
    void run(double seconds) {
        for (int i = 0; i < std::lround(seconds / kLoopPeriod); ++i) step();
    }

    double force() const { return loop.given().force.norm(); }

    AresEmulator emulator;
    AresDevice ares;
    DeviceLoop loop;
    WrenchCommand command{};
    int64_t now_ns = 1'000'000'000;
    double wall_stiffness = kSoftWall;
    const double* force_override = nullptr;
};

OperatorPath pressIntoTheWall() {
    return OperatorPath({{0, {{0, 0, 0.005}, Eigen::Quaterniond::Identity()}, 0},
                         {1.0, {{0, 0, -0.006}, Eigen::Quaterniond::Identity()}, 0}});
}

TEST(ClosedLoop, HandAndWallSettleWhereTheirSpringsBalance) {
    const HandImpedance hand;
    for (const double wall_stiffness : {kSoftWall, kThesisCoupling}) {
        ClosedLoop loop(pressIntoTheWall());
        loop.wall_stiffness = wall_stiffness;
        loop.run(2.0);
        double lowest = 1, highest = -1;
        for (int i = 0; i < 500; ++i) {
            loop.step();
            const double z = loop.emulator.state().X_DT.position.z();
            lowest = std::min(lowest, z);
            highest = std::max(highest, z);
        }
        const double balance = -0.006 * hand.stiffness / (hand.stiffness + wall_stiffness);
        const double coulomb_play = AresPlant{}.coulomb_friction / (hand.stiffness + wall_stiffness);
        EXPECT_NEAR((lowest + highest) / 2, balance, coulomb_play + 5e-6) << wall_stiffness;
        EXPECT_LT(highest - lowest, 5e-6) << wall_stiffness;  // no buzz: less than an encoder step
    }
}

TEST(ClosedLoop, SamplesShowTheTruePoseWithinTheEncoders) {
    ClosedLoop loop(pressIntoTheWall());
    for (int i = 0; i < 1500; ++i) {
        loop.step();
        const Pose& truth = loop.emulator.state().X_DT;
        EXPECT_LT((loop.loop.reading().X_DT.position - truth.position).norm(), 2e-5);
        EXPECT_LT(logRotation(loop.loop.reading().X_DT.rotation * truth.rotation.conjugate()).norm(), 5e-4);
    }
    EXPECT_EQ(loop.loop.unheardPeriods(), 0u);
}

// The handle then falls into the wall, and the hand has to draw it out before the force comes back.
TEST(ClosedLoop, ForceRampsToZeroWhenTheServerFallsSilent) {
    ClosedLoop loop(pressIntoTheWall());
    loop.run(2.5);
    const double pressing = loop.force();
    EXPECT_GT(pressing, 0.5);
    for (int i = 0; i < 15; ++i) loop.step(false);
    EXPECT_NEAR(loop.force(), pressing, 0.05 * pressing);  // silence within tolerance
    Vector6d before = loop.ares.actuatorForces();
    const double most = 0.06 * before.norm();
    for (int i = 0; i < 60; ++i) {
        loop.step(false);
        const Vector6d now = loop.ares.actuatorForces();
        EXPECT_LT((now - before).norm(), most);  // the motors do not jump
        before = now;
    }
    EXPECT_EQ(loop.loop.safety().state(), SafetyState::kPaused);
    EXPECT_EQ(loop.ares.actuatorForces(), Vector6d::Zero());
    loop.run(1.0);
    EXPECT_EQ(loop.force(), 0);  // the wrench is not small
    EXPECT_TRUE(loop.loop.safety().waitsForSmallWrench());
}

TEST(ClosedLoop, ReleaseRampsToZeroAndStaysThere) {
    ClosedLoop loop(pressIntoTheWall());
    loop.run(2.0);
    loop.loop.release();
    EXPECT_FALSE(loop.loop.isReleased());
    loop.run(0.07);
    EXPECT_TRUE(loop.loop.isReleased());
    EXPECT_EQ(loop.ares.actuatorForces(), Vector6d::Zero());
}

TEST(ClosedLoop, NonFiniteCommandsAreSilence) {
    ClosedLoop loop(pressIntoTheWall());
    loop.run(2.0);
    constexpr double kBad[3] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    loop.force_override = kBad;
    for (int i = 0; i < 200; ++i) {
        loop.step();
        ASSERT_TRUE(loop.ares.actuatorForces().allFinite());
    }
    EXPECT_EQ(loop.ares.actuatorForces(), Vector6d::Zero());
}

TEST(ClosedLoop, AnExcessiveForceStopsTheDevice) {
    ClosedLoop loop(OperatorPath{});
    loop.run(0.5);
    constexpr double kHuge[3] = {0, 0, 1000};
    loop.force_override = kHuge;
    for (int i = 0; i < 500; ++i) {
        loop.step();
        EXPECT_LE(loop.force(), 50 * (1 + 1e-12));
        EXPECT_LE(loop.ares.actuatorForces().cwiseAbs().maxCoeff(), 50 * (1 + 1e-12));
    }
    EXPECT_EQ(loop.loop.safety().state(), SafetyState::kProtectiveStop);
    EXPECT_EQ(loop.ares.actuatorForces(), Vector6d::Zero());
}

}  // namespace
}  // namespace bonemill
