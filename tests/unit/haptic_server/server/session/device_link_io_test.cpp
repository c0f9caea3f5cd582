#include "haptic_server/server/session/device_link_io.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <limits>
#include <thread>

#include "common/rt/clock.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {
namespace {

// Runs both sides of the link in one process.
class DeviceLinkIoTest : public testing::Test {
  protected:
    DeviceLinkIoTest()
        : server_(DeviceLink::create(kSession + uint32_t(getpid()), LinkSide::kServer)),
          daemon_(DeviceLink::create(kSession + uint32_t(getpid()), LinkSide::kDaemon)) {
        config_.X_WD = {{0.1, 0.2, 0.3}, Eigen::Quaterniond(M_SQRT1_2, M_SQRT1_2, 0, 0)};
        config_.ramp = {.stale_after_ns = 5'000'000, .ramp_down_ns = 10'000'000, .ramp_up_ns = 10'000'000};
    }
    static DeviceSample sampleAt(double x) {
        DeviceSample sample{};
        sample.stamp_ns = monotonicNowNs();
        sample.p_DT[0] = x;
        sample.q_DT[0] = 1;
        sample.buttons = kButtonRemove;
        sample.state = uint32_t(SafetyState::kEngaged);
        return sample;
    }
    static DeviceCapabilities device(double max_force) {
        return {.name = "arm",
                .kind = uint32_t(DeviceKind::kTouch),
                .abilities = kAbilityForce,
                .max_force = max_force,
                .max_torque = 0,
                .max_stiffness = 1000,
                .max_rotation_stiffness = 0,
                .workspace_radius = 0.1};
    }

    static constexpr uint32_t kSession = 1u << 30;
    DeviceLink server_, daemon_;
    DeviceLinkIoConfig config_;
};

TEST_F(DeviceLinkIoTest, SamplesOfAnotherScenesDeviceDoNotCount) {
    config_.scene_revision = 2;
    DeviceLinkIo io(config_, server_);
    DeviceSample of_other_scene = sampleAt(0.5);
    of_other_scene.scene_revision = 1;
    DeviceSample own = sampleAt(0.01);
    own.scene_revision = 2;
    daemon_.writeSample(own);
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    daemon_.writeSample(of_other_scene);
    ASSERT_TRUE(io.read(input));
    EXPECT_NEAR(input.X_WT_device.position.x(), 0.11, 1e-15);
    EXPECT_EQ(io.implausibleMessages(), 0u) << "it is no fault";
    io.write({});
    WrenchCommand command{};
    ASSERT_TRUE(daemon_.readCommand(command));
    EXPECT_EQ(command.scene_revision, 2u);
}

TEST_F(DeviceLinkIoTest, ForceFadesOutWhenItIsToldTo) {
    config_.ramp.stale_after_ns = 100 * kNsPerSecond;  // a busy machine is no silence
    DeviceLinkIo io(config_, server_);
    EXPECT_TRUE(io.hasFadedOut()) << "there was no force yet";
    DeviceInput input;
    const auto factor = [&] {
        daemon_.writeSample(sampleAt(0));
        EXPECT_TRUE(io.read(input));
        io.write({});
        return input.stale_factor;
    };
    const int64_t start = monotonicNowNs();
    while (factor() < 1) EXPECT_LT(monotonicNowNs() - start, 10 * kNsPerSecond);
    EXPECT_FALSE(io.hasFadedOut());
    EXPECT_EQ(input.buttons, kButtonRemove);
    io.fadeOut();
    const int64_t fade_start = monotonicNowNs();
    double before = 1;
    while (!io.hasFadedOut()) {
        const double now = factor();
        EXPECT_LE(now, before);
        EXPECT_EQ(input.buttons, 0u) << "what resists no more is not milled";
        EXPECT_GE(now, 1 - double(monotonicNowNs() - fade_start) / double(DeviceLinkIo::kFadeNs));
        before = now;
    }
    EXPECT_EQ(factor(), 0) << "it does not come back";
}

TEST_F(DeviceLinkIoTest, PoseAndWrenchChangeFrames) {
    DeviceLinkIo io(config_, server_);
    daemon_.writeSample(sampleAt(0.01));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    EXPECT_LT((input.X_WT_device.position - Eigen::Vector3d(0.11, 0.2, 0.3)).norm(), 1e-15);
    EXPECT_EQ(input.buttons, kButtonRemove);
    EXPECT_EQ(input.wakeup_latency_ns, 0);
    io.write({{0, 0, 2}, {0, 0.1, 0}});
    WrenchCommand command;
    ASSERT_TRUE(daemon_.readCommand(command));
    // D is turned by 90° about x against W: W's +z is D's +y, W's +y is D's -z.
    EXPECT_NEAR(command.f_hand_D[1], 2, 1e-12);
    EXPECT_NEAR(command.t_hand_D[2], -0.1, 1e-12);
    EXPECT_EQ(command.answers_sequence, 1u);
}

TEST_F(DeviceLinkIoTest, SilenceTicksOnAndBecomesStale) {
    DeviceLinkIo io(config_, server_);
    daemon_.writeSample(sampleAt(0));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    EXPECT_FALSE(input.is_repeated);
    const int64_t start = monotonicNowNs();
    while (!input.is_stale) {
        ASSERT_TRUE(io.read(input));
        EXPECT_TRUE(input.is_repeated);
        ASSERT_LT(monotonicNowNs() - start, 10 * kNsPerSecond);
    }
    while (input.stale_factor > 0) {
        ASSERT_TRUE(io.read(input));
        ASSERT_LT(monotonicNowNs() - start, 10 * kNsPerSecond);
    }
    EXPECT_TRUE(input.is_stale);
    while (input.is_stale) {
        daemon_.writeSample(sampleAt(0.001));
        ASSERT_TRUE(io.read(input));
        EXPECT_FALSE(input.is_repeated);
    }
    EXPECT_LT(input.stale_factor, 1);  // it fades in
}

TEST_F(DeviceLinkIoTest, ALateTickLivesThroughThePeriodsBeforeIt) {
    DeviceLinkIo io(config_, server_);
    daemon_.writeSample(sampleAt(0));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    EXPECT_EQ(input.periods, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(6));
    daemon_.writeSample(sampleAt(0));
    ASSERT_TRUE(io.read(input));
    EXPECT_GE(input.periods, 6);
    EXPECT_LE(input.periods, LivedPeriods::kMaxNs / config_.period_ns);
}

// The device says how far it reaches; before it has, ten metres are believed.
TEST_F(DeviceLinkIoTest, SamplesFarBeyondTheDevicesReachAreNotBelieved) {
    DeviceLinkIo io(config_, server_);
    daemon_.writeSample(sampleAt(0.5));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    EXPECT_NEAR(input.X_WT_device.position.x(), 0.6, 1e-12);
    daemon_.writeCapabilities(device(3));  // it reaches 0.1 m
    daemon_.writeSample(sampleAt(0.15));
    ASSERT_TRUE(io.read(input));
    EXPECT_NEAR(input.X_WT_device.position.x(), 0.25, 1e-12);
    EXPECT_EQ(io.implausibleMessages(), 0u);
    daemon_.writeSample(sampleAt(0.21));
    ASSERT_TRUE(io.read(input));
    EXPECT_NEAR(input.X_WT_device.position.x(), 0.25, 1e-12);
    EXPECT_EQ(io.implausibleMessages(), 1u);
    EXPECT_TRUE(input.faults & kFaultImplausibleDevice);
}

TEST_F(DeviceLinkIoTest, ImplausibleSamplesAndStampsAreNotBelieved) {
    DeviceLinkIo io(config_, server_);
    daemon_.writeSample(sampleAt(0.002));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    DeviceSample garbage = sampleAt(std::numeric_limits<double>::quiet_NaN());
    garbage.stamp_ns = std::numeric_limits<int64_t>::min();
    daemon_.writeSample(garbage);
    ASSERT_TRUE(io.read(input));
    EXPECT_EQ(io.implausibleMessages(), 1u);
    EXPECT_TRUE(input.faults & kFaultImplausibleDevice);
    EXPECT_NEAR(input.X_WT_device.position.x(), 0.102, 1e-12);
    for (const int64_t stamp :
         {std::numeric_limits<int64_t>::min(), int64_t(0), std::numeric_limits<int64_t>::max()}) {
        DeviceSample odd = sampleAt(0.003);
        odd.stamp_ns = stamp;
        daemon_.writeSample(odd);
        ASSERT_TRUE(io.read(input));
        EXPECT_LT(input.wakeup_latency_ns, 10 * kNsPerSecond);
    }
}

TEST_F(DeviceLinkIoTest, TheToolMovesAsFarAsTheScaleSaysAndTurnsWithTheHandle) {
    config_.hand_space = HandSpace(3);
    DeviceLinkIo io(config_, server_);
    DeviceSample sample = sampleAt(0.01);
    sample.q_DT[0] = sample.q_DT[3] = M_SQRT1_2;
    daemon_.writeSample(sample);
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    EXPECT_LT((input.X_WT_device.position - Eigen::Vector3d(0.13, 0.2, 0.3)).norm(), 1e-15);
    const Eigen::Quaterniond expected =
        config_.X_WD.rotation * Eigen::Quaterniond(M_SQRT1_2, 0, 0, M_SQRT1_2);
    EXPECT_LT(expected.angularDistance(input.X_WT_device.rotation), 1e-12);
}

TEST_F(DeviceLinkIoTest, TheTickHearsOfEachOtherDeviceOnce) {
    DeviceLinkIo io(config_, server_);
    DeviceCapabilities shown;
    EXPECT_FALSE(io.capabilities(shown));
    const auto next = [&] {
        daemon_.writeSample(sampleAt(0));
        DeviceInput input;
        EXPECT_TRUE(io.read(input));
        return input;
    };
    EXPECT_FALSE(next().other_device) << "nobody has told of a device";
    daemon_.writeCapabilities(device(3));
    const DeviceInput first = next();
    ASSERT_TRUE(first.other_device);
    EXPECT_EQ(first.other_device->max_force, 3);
    EXPECT_TRUE(io.capabilities(shown));
    EXPECT_STREQ(shown.name, "arm");
    EXPECT_FALSE(next().other_device);
    daemon_.writeCapabilities(device(3));
    EXPECT_FALSE(next().other_device) << "it is the same";
    DeviceCapabilities garbage = device(std::numeric_limits<double>::quiet_NaN());
    daemon_.writeCapabilities(garbage);
    const DeviceInput refused = next();
    EXPECT_FALSE(refused.other_device);
    EXPECT_TRUE(refused.faults & kFaultImplausibleDevice);
    EXPECT_EQ(io.implausibleMessages(), 1u);
    EXPECT_TRUE(io.capabilities(shown) && shown.max_force == 3) << "the last good one stays";
    daemon_.writeCapabilities(device(7));
    const DeviceInput other = next();
    EXPECT_TRUE(other.other_device && other.other_device->max_force == 7);
    EXPECT_FALSE(other.faults & kFaultImplausibleDevice);
}

TEST_F(DeviceLinkIoTest, TheDevicesStateComesThroughAndOrdersToResetItGoOut) {
    DeviceLinkIo io(config_, server_);
    DeviceSample stopped = sampleAt(0);
    stopped.state = uint32_t(SafetyState::kProtectiveStop);
    stopped.stop_cause = uint32_t(StopCause::kDeviceFault);
    stopped.fault_code = 17;
    stopped.flags = kDeviceFlagSimulated | kDeviceFlagEnabled;
    daemon_.writeSample(stopped);
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    EXPECT_FALSE(input.device.isEngaged());
    EXPECT_EQ(input.device.state, stopped.state);
    EXPECT_EQ(input.device.stop_cause, stopped.stop_cause);
    EXPECT_EQ(input.device.fault_code, 17u);
    EXPECT_EQ(input.device.flags, stopped.flags);
    WrenchCommand command;
    io.write({});
    ASSERT_TRUE(daemon_.readCommand(command));
    EXPECT_EQ(command.reset_orders, 0u);
    io.resetOrders().fetch_add(1);
    io.write({});
    ASSERT_TRUE(daemon_.readCommand(command));
    EXPECT_EQ(command.reset_orders, 1u);
}

// The daemon of this test writes as fast as it can, in between garbage. What is judged is each tick's own
// start, which no load can bring forward.
TEST_F(DeviceLinkIoTest, AFloodOfSamplesDoesNotHurryTheTick) {
    DeviceLinkIo io(config_, server_);
    std::atomic<bool> is_over{false};
    std::thread flood([&] {
        for (uint64_t n = 0; !is_over; ++n)
            daemon_.writeSample(sampleAt(n % 3 ? 0.001 : std::numeric_limits<double>::quiet_NaN()));
    });
    constexpr int kTicks = 100, kMaxTicks = 20'000;  // on a busy machine the flood may be late
    int64_t first = 0, last = 0;
    uint32_t faults = 0;
    int ticks = 0;
    for (int tick = 0; tick < kTicks || (!(faults & kFaultEarlySamples) && tick < kMaxTicks); ++tick) {
        DeviceInput input;
        ASSERT_TRUE(io.read(input));
        if (tick > 0) {
            EXPECT_GE(input.start_ns - last, config_.period_ns / 2);
        }
        last = input.start_ns;
        if (tick == 0) first = last;
        faults |= input.faults;
        ticks = tick + 1;
    }
    is_over = true;
    flood.join();
    EXPECT_GE(last - first, (ticks - 5) * config_.period_ns * 63 / 64) << "the simulation runs too fast";
    EXPECT_GT(io.earlySamples(), 0u);
    EXPECT_TRUE(faults & kFaultEarlySamples);
}

TEST_F(DeviceLinkIoTest, EndsOnStopAndWithItsDevice) {
    DeviceInput input;
    DeviceLinkIo stopped(config_, server_);
    stopped.stop();
    EXPECT_FALSE(stopped.read(input));

    config_.ends_with_device = true;
    DeviceLinkIo io(config_, server_);
    daemon_.writeSample(sampleAt(0));
    ASSERT_TRUE(io.read(input));
    DeviceSample goodbye = sampleAt(0);
    goodbye.flags = kDeviceFlagLeaving;
    daemon_.writeSample(goodbye);
    ASSERT_TRUE(io.read(input));
    EXPECT_TRUE(io.hasDeviceLeft());
    EXPECT_FALSE(io.read(input));
}

}  // namespace
}  // namespace bonemill
