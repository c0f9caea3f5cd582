#include "common/device_messages/device_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace bonemill {
namespace {

constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), 1e300};

DeviceSample restingSample() {
    DeviceSample sample{};
    sample.q_DT[0] = 1.0;
    return sample;
}

TEST(DeviceMessages, zeroedSampleIsNotPlausible) {
    EXPECT_FALSE(isPlausible(DeviceSample{}));
}

TEST(DeviceMessages, everyPoseComponentIsChecked) {
    ASSERT_TRUE(isPlausible(restingSample()));
    for (const double bad : kBad) {
        for (int i = 0; i < 3; ++i) {
            DeviceSample sample = restingSample();
            sample.p_DT[i] = bad;
            EXPECT_FALSE(isPlausible(sample)) << "p " << i << ' ' << bad;
        }
        for (int i = 0; i < 4; ++i) {
            DeviceSample sample = restingSample();
            sample.q_DT[i] = bad;
            EXPECT_FALSE(isPlausible(sample)) << "q " << i << ' ' << bad;
        }
    }
}

TEST(DeviceMessages, quaternionNormMustBeNearOne) {
    for (const double norm : {0.9995, 1.0005}) {
        DeviceSample sample = restingSample();
        sample.q_DT[0] = 0.6 * norm;
        sample.q_DT[2] = 0.8 * norm;
        EXPECT_TRUE(isPlausible(sample)) << norm;
    }
    for (const double norm : {0.0, 0.99, 1.01}) {
        DeviceSample sample = restingSample();
        sample.q_DT[0] = norm;
        EXPECT_FALSE(isPlausible(sample)) << norm;
    }
}

TEST(DeviceMessages, placeAndSpeedsMustBePossible) {
    struct {
        double (DeviceSample::*vector)[3];
        double most;
    } const cases[] = {{&DeviceSample::p_DT, kMaxDeviceReach},
                       {&DeviceSample::v_DT, kMaxDeviceSpeed},
                       {&DeviceSample::w_DT, kMaxDeviceSpin}};
    for (const auto& [vector, most] : cases) {
        for (int i = 0; i < 3; ++i) {
            DeviceSample sample = restingSample();
            (sample.*vector)[i] = -most;
            EXPECT_TRUE(isPlausible(sample)) << most << ' ' << i;
            for (const double bad : {-1.001 * most, 1.001 * most, kBad[0], kBad[1], kBad[2], kBad[3]}) {
                (sample.*vector)[i] = bad;
                EXPECT_FALSE(isPlausible(sample)) << most << ' ' << i << ' ' << bad;
            }
        }
    }
}

TEST(DeviceMessages, stateAndCauseMustBeKnown) {
    for (const uint32_t number : {0u, 1u, 5u, 8u, 9u, 13u, 14u, 1u << 31, UINT32_MAX}) {
        DeviceSample sample = restingSample();
        sample.state = number;
        EXPECT_EQ(isPlausible(sample), number <= uint32_t(SafetyState::kFault)) << number;
        sample = restingSample();
        sample.stop_cause = number;
        EXPECT_EQ(isPlausible(sample), number <= uint32_t(StopCause::kLatePackets)) << number;
    }
}

// The device's own numbers, counters and bits mean what they like.
TEST(DeviceMessages, otherNumbersAreFree) {
    DeviceSample sample = restingSample();
    sample.sequence = UINT64_MAX;
    sample.stamp_ns = INT64_MIN;
    sample.buttons = sample.flags = sample.fault_code = sample.reset_count = UINT32_MAX;
    EXPECT_TRUE(isPlausible(sample));
    WrenchCommand command{};
    command.sequence = command.answers_sequence = UINT64_MAX;
    command.stamp_ns = INT64_MAX;
    command.reset_orders = UINT32_MAX;
    EXPECT_TRUE(isPlausible(command));
}

TEST(DeviceMessages, wrenchMustBeFinite) {
    EXPECT_TRUE(isPlausible(WrenchCommand{}));
    for (int i = 0; i < 3; ++i) {
        WrenchCommand command{};
        command.f_hand_D[i] = std::nan("");
        EXPECT_FALSE(isPlausible(command));
        command = {};
        command.t_hand_D[i] = -INFINITY;
        EXPECT_FALSE(isPlausible(command));
    }
}

TEST(DeviceMessages, nameOfTheDeviceMustEnd) {
    DeviceCapabilities device{};
    EXPECT_TRUE(isPlausible(device));
    std::memset(device.name, 'x', sizeof(device.name) - 1);
    EXPECT_TRUE(isPlausible(device));
    device.name[sizeof(device.name) - 1] = 'x';
    EXPECT_FALSE(isPlausible(device));
}

TEST(DeviceMessages, kindOfTheDeviceMustBeKnown) {
    for (const uint32_t kind : {0u, 1u, 8u, 9u, UINT32_MAX}) {
        DeviceCapabilities device{};
        device.kind = kind;
        EXPECT_EQ(isPlausible(device), kind <= uint32_t(DeviceKind::kGamepad)) << kind;
    }
}

TEST(DeviceMessages, whatMovesMustBeAHandles) {
    DeviceCapabilities device{};
    device.handle = {0.25, 2, 1e-4, 0.004, 0.3e-3, 1e-3, 5e-6, 1e-4};
    ASSERT_TRUE(isPlausible(device));
    const HandleDynamics handle = device.handle;
    for (const auto figure :
         {&HandleDynamics::mass, &HandleDynamics::damping, &HandleDynamics::inertia,
          &HandleDynamics::angular_damping, &HandleDynamics::amplifier_time, &HandleDynamics::delay,
          &HandleDynamics::encoder_step, &HandleDynamics::encoder_angle}) {
        device.handle = handle;
        device.handle.*figure = 0;
        EXPECT_TRUE(isPlausible(device));
        for (const double bad : {-1e-9, 1e7, kBad[0], kBad[1], kBad[2]}) {
            device.handle.*figure = bad;
            EXPECT_FALSE(isPlausible(device)) << bad;
        }
    }
    for (const auto figure : {&HandleDynamics::mass, &HandleDynamics::inertia, &HandleDynamics::encoder_step,
                              &HandleDynamics::encoder_angle}) {
        device.handle = handle;
        device.handle.*figure = 2.6e-319;  // 0.25 with its bytes in the wrong order
        EXPECT_FALSE(isPlausible(device));
    }
}

TEST(DeviceMessages, figuresOfTheDeviceMustBeFiniteAndNotNegative) {
    for (const auto figure :
         {&DeviceCapabilities::max_force, &DeviceCapabilities::max_torque, &DeviceCapabilities::max_stiffness,
          &DeviceCapabilities::max_rotation_stiffness, &DeviceCapabilities::workspace_radius}) {
        DeviceCapabilities device{};
        device.*figure = 10;
        EXPECT_TRUE(isPlausible(device));
        for (const double bad : {-1e-9, 5e-324, 1e-300, 1e12, kBad[0], kBad[1], kBad[2]}) {
            device.*figure = bad;
            EXPECT_FALSE(isPlausible(device)) << bad;
        }
    }
}

}  // namespace
}  // namespace bonemill
