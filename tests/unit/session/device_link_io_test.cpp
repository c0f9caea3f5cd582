#include "haptic_server/session/device_link_io.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

// Runs both sides of the link in one process.
class DeviceLinkIoTest : public testing::Test {
  protected:
    DeviceLinkIoTest()
        : server_(DeviceLink::create(kSession + uint32_t(getpid()), LinkSide::kServer, 1)),
          daemon_(DeviceLink::create(kSession + uint32_t(getpid()), LinkSide::kDaemon, 1)),
          ring_(64),
          cuts_(64) {
        config_.X_WD = {{0.1, 0.2, 0.3}, Eigen::Quaterniond(M_SQRT1_2, M_SQRT1_2, 0, 0)};
        config_.ramp = {.stale_after_ns = 5'000'000, .ramp_down_ns = 10'000'000, .ramp_up_ns = 10'000'000};
    }
    static DeviceSample sampleAt(double x) {
        DeviceSample sample{};
        sample.stamp_ns = monotonicNowNs();
        sample.p_DT[0] = x;
        sample.q_DT[0] = 1;
        sample.buttons = kButtonRemove;
        return sample;
    }

    static constexpr uint32_t kSession = 1u << 30;
    DeviceLink server_, daemon_;
    SpscRing<TickRecord> ring_;
    SpscRing<Cut> cuts_;
    DeviceLinkIoConfig config_;
};

TEST_F(DeviceLinkIoTest, PoseAndWrenchChangeFrames) {
    DeviceLinkIo io(config_, server_, ring_, cuts_);
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
    DeviceLinkIo io(config_, server_, ring_, cuts_);
    daemon_.writeSample(sampleAt(0));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    const int64_t start = monotonicNowNs();
    while (!input.is_stale) {
        ASSERT_TRUE(io.read(input));
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
    }
    EXPECT_LT(input.stale_factor, 1);  // it fades in
}

TEST_F(DeviceLinkIoTest, ImplausibleSamplesAndStampsAreNotBelieved) {
    DeviceLinkIo io(config_, server_, ring_, cuts_);
    daemon_.writeSample(sampleAt(0.002));
    DeviceInput input;
    ASSERT_TRUE(io.read(input));
    DeviceSample garbage = sampleAt(std::numeric_limits<double>::quiet_NaN());
    garbage.stamp_ns = std::numeric_limits<int64_t>::min();
    daemon_.writeSample(garbage);
    ASSERT_TRUE(io.read(input));
    EXPECT_EQ(io.implausibleSamples(), 1u);
    EXPECT_NEAR(input.X_WT_device.position.x(), 0.102, 1e-12);
    for (const int64_t stamp :
         {std::numeric_limits<int64_t>::min(), int64_t(0), std::numeric_limits<int64_t>::max()}) {
        DeviceSample odd = sampleAt(0.003);
        odd.stamp_ns = stamp;
        daemon_.writeSample(odd);
        ASSERT_TRUE(io.read(input));
        EXPECT_GE(input.wakeup_latency_ns, 0);
        EXPECT_LT(input.wakeup_latency_ns, 10 * kNsPerSecond);
    }
}

TEST_F(DeviceLinkIoTest, TheMesherIsToldOfCutsAndOfNothingElse) {
    DeviceLinkIo io(config_, server_, ring_, cuts_);
    TickRecord idle{}, milling{};
    milling.cut = cutOf({{1, 2, 3}, {4, 5, 6}}, 5);
    io.push(idle);
    io.push(milling);
    Cut cut;
    ASSERT_TRUE(cuts_.tryPop(cut));
    EXPECT_EQ(cut.start_ns, 5);
    EXPECT_EQ(cut.voxels().max, Eigen::Vector3i(4, 5, 6));
    EXPECT_FALSE(cuts_.tryPop(cut));
    TickRecord record;
    EXPECT_TRUE(ring_.tryPop(record) && ring_.tryPop(record));
}

TEST_F(DeviceLinkIoTest, EndsOnStopAndWithItsDevice) {
    DeviceInput input;
    DeviceLinkIo stopped(config_, server_, ring_, cuts_);
    stopped.stop();
    EXPECT_FALSE(stopped.read(input));

    config_.ends_with_device = true;
    DeviceLinkIo io(config_, server_, ring_, cuts_);
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
