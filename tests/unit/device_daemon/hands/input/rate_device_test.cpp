// What SpaceMouse and gamepad have in common: the handle goes at the rates, gives way to the wrench, presses
// no harder than a hand, holds still against a wall, and rests while nothing is plugged in.
#include "device_daemon/hands/input/rate_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>

namespace bonemill {
namespace {

constexpr double kPeriod = 1e-3;  // s, of the loop
constexpr double kWall = 3000;    // N/m

class TestedDevice final : public RateDevice {
  public:
    explicit TestedDevice(const RateConfig& config = {})
        : RateDevice(DeviceKind::kGamepad, "tested", config, Pose{}) {}
    using RateDevice::felt;
    using RateDevice::publish;
    using RateDevice::takeName;
};

HandInput pushed(const std::array<float, 6>& deflections, uint32_t buttons = 0) {
    return {.deflections = deflections, .buttons = buttons, .is_fine = 0, .is_there = 1};
}

// A wall below `height`, felt one period late.
struct WalledDevice {
    TestedDevice device;
    DeviceReading reading;
    DeviceOrder order{.wrench_hand_D = {}, .is_wanted = true, .is_engaged = true};
    double height = -0.01;

    void run(double seconds) {
        for (int i = 0; i < std::lround(seconds / kPeriod); ++i) {
            ASSERT_TRUE(device.read(kPeriod, reading));
            device.write(order);
            const double depth = height - reading.X_DT.position.z();
            order.wrench_hand_D.force.z() = depth > 0 ? kWall * depth : 0;
        }
    }
};

TEST(RateDevice, AFreeHandleGoesAtTheRate) {
    TestedDevice device;
    DeviceReading reading;
    device.publish(pushed({1, 0, 0, 0, 0, 1}));
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(device.read(kPeriod, reading));
    const RateConfig config;
    EXPECT_NEAR(reading.v_DT.x(), config.max_speed, 0.01 * config.max_speed);
    EXPECT_NEAR(reading.w_DT.z(), config.max_spin, 0.01 * config.max_spin);
    const double before = reading.X_DT.position.x();
    for (int i = 0; i < 1000; ++i) device.read(kPeriod, reading);
    EXPECT_NEAR(reading.X_DT.position.x() - before, config.max_speed, 0.01 * config.max_speed);
    EXPECT_EQ(reading.status, kStatusPowered | kStatusCalibrated | kStatusDriving);
}

TEST(RateDevice, StandsStillWithinTheDeadZone) {
    TestedDevice device;
    DeviceReading reading;
    device.publish(pushed({0.05f, -0.05f, 0.05f, 0.05f, 0.05f, -0.05f}));
    for (int i = 0; i < 1000; ++i) device.read(kPeriod, reading);
    EXPECT_LT(reading.X_DT.position.norm(), 1e-12);
}

TEST(RateDevice, AWallStopsItAndTheHandPressesWithItsStrengthAndNoMore) {
    WalledDevice walled;
    walled.device.publish(pushed({0, 0, -1, 0, 0, 0}));
    walled.run(0.1);
    double hardest = 0;
    for (int i = 0; i < 5000; ++i) {
        walled.run(kPeriod);
        hardest = std::max(hardest, walled.order.wrench_hand_D.force.z());
    }
    const double strength = VirtualHand{}.max_force;
    EXPECT_NEAR(walled.order.wrench_hand_D.force.z(), strength, 0.05 * strength);
    EXPECT_LT(hardest, 1.1 * strength);
    EXPECT_LT(walled.reading.v_DT.norm(), 1e-3);
}

TEST(RateDevice, LeavesTheWallAtOnceWhenTheDirectionTurns) {
    WalledDevice walled;
    walled.device.publish(pushed({0, 0, -1, 0, 0, 0}));
    walled.run(5);
    walled.device.publish(pushed({0, 0, 1, 0, 0, 0}));
    // The spring of the hand is 13 mm long at full strength and unwinds at 60 mm/s.
    walled.run(0.5);
    EXPECT_GT(walled.reading.X_DT.position.z(), walled.height);
}

TEST(RateDevice, RestsStillOnTheWallWhenLetGo) {
    WalledDevice walled;
    walled.device.publish(pushed({0, 0, -1, 0, 0, 0}));
    walled.run(2);
    walled.device.publish(pushed({}));
    walled.run(1);
    double lowest = 1, highest = -1;
    for (int i = 0; i < 2000; ++i) {
        walled.run(kPeriod);
        lowest = std::min(lowest, walled.reading.X_DT.position.z());
        highest = std::max(highest, walled.reading.X_DT.position.z());
    }
    EXPECT_LT(highest - lowest, 1e-6);
    EXPECT_LT(walled.reading.v_DT.norm(), 1e-6);
}

TEST(RateDevice, UnpluggedItRestsWithButtonsUpAndGoesOnWhereItWas) {
    TestedDevice device;
    DeviceReading reading;
    EXPECT_FALSE(device.read(kPeriod, reading));
    device.publish(pushed({1, 0, 0, 0, 0, 0}, kButtonRemove));
    for (int i = 0; i < 500; ++i) device.read(kPeriod, reading);
    EXPECT_EQ(reading.buttons, kButtonRemove);
    device.publish({});
    EXPECT_FALSE(device.read(kPeriod, reading));
    EXPECT_EQ(reading.buttons, 0u);
    for (int i = 0; i < 500; ++i) EXPECT_FALSE(device.read(kPeriod, reading));
    EXPECT_LT(reading.v_DT.norm(), 1e-6);
    const double x = reading.X_DT.position.x();
    device.publish(pushed({1, 0, 0, 0, 0, 0}));
    ASSERT_TRUE(device.read(kPeriod, reading));
    EXPECT_NEAR(reading.X_DT.position.x(), x, 1e-3);
    for (int i = 0; i < 500; ++i) device.read(kPeriod, reading);
    EXPECT_GT(reading.X_DT.position.x(), x + 0.02);
}

TEST(RateDevice, FeelsWhatIsOrderedIfItIsFinite) {
    TestedDevice device;
    DeviceReading reading;
    device.publish(pushed({}));
    DeviceOrder order{.wrench_hand_D = {}, .is_wanted = true, .is_engaged = true};
    order.wrench_hand_D.force = {5, 0, 0};
    device.write(order);
    for (int i = 0; i < 1000; ++i) device.read(kPeriod, reading);
    EXPECT_NEAR(reading.X_DT.position.x(), 5 / VirtualHand{}.stiffness, 1e-3);
    EXPECT_EQ(device.felt().force, 5);
    EXPECT_EQ(reading.applied_D.force.x(), 5);
    order.is_engaged = false;
    device.write(order);
    device.read(kPeriod, reading);
    EXPECT_EQ(reading.applied_D.force.x(), 5) << "in a pause it fades";
    order.wrench_hand_D.force.x() = std::numeric_limits<double>::quiet_NaN();
    device.write(order);
    device.read(kPeriod, reading);
    EXPECT_TRUE(reading.X_DT.isFinite());
    EXPECT_EQ(device.felt().force, 0);
}

TEST(RateDevice, SaysWhatItIsAndTellsOfANewName) {
    TestedDevice device;
    const uint32_t version = device.capabilitiesVersion();
    EXPECT_STREQ(device.capabilities().name, "tested");
    device.takeName(std::string(200, 'x'));
    EXPECT_NE(device.capabilitiesVersion(), version);
    const DeviceCapabilities capabilities = device.capabilities();
    EXPECT_TRUE(isPlausible(capabilities));
    EXPECT_EQ(std::string(capabilities.name).size(), sizeof capabilities.name - 1);
    EXPECT_EQ(capabilities.kind, uint32_t(DeviceKind::kGamepad));
    EXPECT_GT(capabilities.max_force, VirtualHand{}.max_force);
    EXPECT_FALSE(device.hasClock());
}

// For ThreadSanitizer: the loop takes only whole inputs.
TEST(RateDevice, TakesWholeInputsFromAnotherThread) {
    TestedDevice device;
    std::atomic<bool> should_stop = false;
    std::thread publisher([&] {
        for (uint32_t i = 0; !should_stop; ++i) {
            const float share = i % 2 ? 1.0f : -1.0f;
            device.publish(
                pushed({share, share, share, share, share, share}, i % 2 ? kButtonRemove : kButtonAdd));
            if (i % 100 == 0) device.takeName("pad " + std::to_string(i));
            (void)device.felt();
        }
    });
    DeviceReading reading;
    while (!device.read(0, reading)) std::this_thread::yield();
    for (int i = 0; i < 3000; ++i) {
        device.read(kPeriod, reading);
        device.write({.wrench_hand_D = {}, .is_wanted = true, .is_engaged = true});
        EXPECT_TRUE(reading.buttons == kButtonRemove || reading.buttons == kButtonAdd);
        EXPECT_TRUE(isPlausible(device.capabilities()));
    }
    should_stop = true;
    publisher.join();
}

}  // namespace
}  // namespace bonemill
