#include "common/device_messages/device_messages.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bonemill {
namespace {

bool isFinite(const double (&v)[3]) noexcept {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

// It is false for NaN, too.
bool isWithin(const double (&v)[3], double most) noexcept {
    return std::abs(v[0]) <= most && std::abs(v[1]) <= most && std::abs(v[2]) <= most;
}

// It is zero, and then none or not known, or what a device can have: bytes in a wrong order seldom are.
bool isNoneOrWithin(double value, double least, double most) noexcept {
    return value == 0 || (value >= least && value <= most);
}

bool isPlausible(const HandleDynamics& handle) noexcept {
    constexpr double kMaxTime = 1;  // s
    return isNoneOrWithin(handle.mass, 1e-4, 1e3) && isNoneOrWithin(handle.inertia, 1e-9, 1e2) &&
           isNoneOrWithin(handle.damping, 0, 1e5) && isNoneOrWithin(handle.angular_damping, 0, 1e4) &&
           isNoneOrWithin(handle.amplifier_time, 0, kMaxTime) && isNoneOrWithin(handle.delay, 0, kMaxTime) &&
           isNoneOrWithin(handle.encoder_step, 1e-12, 1e-2) && isNoneOrWithin(handle.encoder_angle, 1e-12, 1);
}

}  // namespace

bool isPlausible(const DeviceSample& sample) noexcept {
    double squared_norm = 0.0;
    for (const double component : sample.q_DT) squared_norm += component * component;
    return isWithin(sample.p_DT, kMaxDeviceReach) &&
           std::abs(std::sqrt(squared_norm) - 1.0) <= kQuaternionNormTolerance &&
           isWithin(sample.v_DT, kMaxDeviceSpeed) && isWithin(sample.w_DT, kMaxDeviceSpin) &&
           sample.state < kSafetyStateCount && sample.stop_cause < kStopCauseCount;
}

bool isWithinReach(const DeviceSample& sample, const DeviceCapabilities& device) noexcept {
    const double(&p)[3] = sample.p_DT;
    const double most = 2 * device.workspace_radius;
    return most == 0 || p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= most * most;
}

bool isPlausible(const WrenchCommand& command) noexcept {
    return isFinite(command.f_hand_D) && isFinite(command.t_hand_D);
}

bool isPlausible(const DeviceCapabilities& capabilities) noexcept {
    const auto end = std::end(capabilities.name);
    return std::find(std::begin(capabilities.name), end, '\0') != end &&
           capabilities.kind < kDeviceKindCount && isNoneOrWithin(capabilities.max_force, 1e-9, 1e6) &&
           isNoneOrWithin(capabilities.max_torque, 1e-9, 1e6) &&
           isNoneOrWithin(capabilities.max_stiffness, 1e-9, 1e9) &&
           isNoneOrWithin(capabilities.max_rotation_stiffness, 1e-9, 1e9) &&
           isNoneOrWithin(capabilities.workspace_radius, 1e-9, 1e6) && isPlausible(capabilities.handle);
}

bool isPlausible(const SceneNotice& notice) noexcept {
    const char* const end = std::find(std::begin(notice.path), std::end(notice.path), '\0');
    const auto is_control = [](char c) { return (unsigned char)c < ' ' || c == 127; };
    return notice.revision != 0 && notice.hand <= uint32_t(HandChoice::kPointer) && notice.path[0] == '/' &&
           end != std::end(notice.path) && std::none_of(std::begin(notice.path), end, is_control);
}

}  // namespace bonemill
