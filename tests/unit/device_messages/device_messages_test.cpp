#include "common/device_messages/device_messages.h"

#include <gtest/gtest.h>

#include <cmath>
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

TEST(DeviceMessages, positionMustBeWithinReach) {
    DeviceSample sample = restingSample();
    sample.p_DT[1] = -kLargestDeviceReach;
    EXPECT_TRUE(isPlausible(sample));
    sample.p_DT[1] = -1.001 * kLargestDeviceReach;
    EXPECT_FALSE(isPlausible(sample));
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

}  // namespace
}  // namespace bonemill
