#include "haptic_server/server/session/shown_device.h"

#include <algorithm>
#include <cstdio>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kMaxShown = 1e6;  // viewers refuse larger numbers

// The name comes from another process, and messages hold UTF-8.
std::string readableName(const char* name) {
    std::string shown;
    for (const char* c = name; *c != 0; ++c) shown += *c >= ' ' && *c <= '~' ? *c : '?';
    return shown;
}

}  // namespace

topics::Device shownDevice(const TickRecord& record, const DeviceCapabilities* capabilities) {
    const DeviceReport& report = record.device;
    topics::Device device;
    device.set_state(report.state);
    device.set_stop_cause(report.stop_cause);
    device.set_fault_code(report.fault_code);
    device.set_is_simulated(report.flags & kDeviceFlagSimulated);
    device.set_is_force_limited(report.flags & kDeviceFlagForceLimited);
    device.set_is_enabled(report.flags & kDeviceFlagEnabled);
    device.set_force_waits(report.flags & kDeviceFlagForceWaits);
    device.set_coupling_share(record.coupling_share);
    device.set_rotation_share(record.rotation_share);
    if (!capabilities) return device;
    device.set_name(readableName(capabilities->name));
    device.set_kind(capabilities->kind);
    device.set_abilities(capabilities->abilities);
    device.set_max_force_n(std::min(capabilities->max_force, kMaxShown));
    device.set_max_torque_nmm(std::min(capabilities->max_torque * kPerMilli, kMaxShown));
    return device;
}

std::string deviceText(const DeviceCapabilities& capabilities) {
    const auto most = [](bool is_able, double value, const char* unit, const char* none) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g %s", value, unit);
        return std::string(is_able && value > 0 ? text : none);
    };
    return readableName(capabilities.name) + ": " +
           most(capabilities.abilities & kAbilityForce, capabilities.max_force, "N", "no force") + ", " +
           most(capabilities.abilities & kAbilityTorque, capabilities.max_torque * kPerMilli, "N·mm",
                "no torque");
}

}  // namespace bonemill
