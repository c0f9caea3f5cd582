#include "common/device_messages/device_messages.h"

#include <cmath>

namespace bonemill {
namespace {

bool isFinite(const double (&v)[3]) noexcept {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace

bool isPlausible(const DeviceSample& sample) noexcept {
    for (const double coordinate : sample.p_DT) {
        if (!(std::abs(coordinate) <= kLargestDeviceReach)) return false;  // also refuses NaN
    }
    double squared_norm = 0.0;
    for (const double component : sample.q_DT) squared_norm += component * component;
    return std::abs(std::sqrt(squared_norm) - 1.0) <= kQuaternionNormTolerance;
}

bool isPlausible(const WrenchCommand& command) noexcept {
    return isFinite(command.f_hand_D) && isFinite(command.t_hand_D);
}

}  // namespace bonemill
