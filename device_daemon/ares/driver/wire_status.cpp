#include "device_daemon/ares/driver/wire_status.h"

#include <algorithm>
#include <utility>

#include "device_daemon/ares/wire/drive_state.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {
namespace {

constexpr uint16_t kVoltageEnabledBit = 1u << 4;

constexpr uint32_t kPassingFaults =
    wire::kFaultOverTemperature | wire::kFaultOverSpeed | wire::kFaultWatchdog | wire::kFaultLatePackets;

// The first one that is there counts, and the gravest comes first: what is broken, and what no user has given
// a name, before what passes.
constexpr std::pair<uint32_t, StopCause> kCauses[] = {
    {wire::kFaultEmergencyStop, StopCause::kEmergencyStop},
    {~kPassingFaults, StopCause::kDeviceFault},
    {wire::kFaultOverTemperature, StopCause::kOverTemperature},
    {wire::kFaultOverSpeed, StopCause::kSpeed},
    {wire::kFaultWatchdog, StopCause::kDeviceLost},
    {wire::kFaultLatePackets, StopCause::kLatePackets},
};

}  // namespace

uint32_t deviceStatusOf(uint32_t inputs, uint16_t statusword, bool is_trusted) noexcept {
    const bool has_voltage = (statusword & kVoltageEnabledBit) && !(inputs & wire::kInputBrake);
    const bool is_driving = wire::driveStateOf(statusword) == wire::DriveState::kOperationEnabled;
    uint32_t status = 0;
    if (is_trusted && has_voltage) status |= kStatusPowered;
    if (is_trusted && is_driving) status |= kStatusDriving;
    if (inputs & wire::kInputHomed) status |= kStatusCalibrated;
    if (inputs & wire::kInputHoming) status |= kStatusHoming;
    if (inputs & wire::kInputEnabled) status |= kStatusEnabled;
    if (!(inputs & wire::kInputChainClosed)) status |= kStatusEmergencyStop;
    if (inputs & wire::kInputReset) status |= kStatusResetPressed;
    if (inputs & wire::kInputLeaving) status |= kStatusLeaving;
    return status;
}

StopCause stopCauseOf(uint32_t faults) noexcept {
    for (const auto& [bits, cause] : kCauses) {
        if (faults & bits) return cause;
    }
    return StopCause::kNone;
}

uint32_t buttonsOf(uint32_t inputs) noexcept {
    return (inputs >> wire::kFirstButtonInput) & (kButtonRemove | kButtonAdd);
}

DeviceCapabilities capabilitiesOf(const wire::Describe& d) noexcept {
    DeviceCapabilities capabilities{};
    static_assert(sizeof(capabilities.name) == sizeof(d.name));
    std::copy(std::begin(d.name), std::end(d.name), capabilities.name);
    capabilities.kind = d.kind;
    capabilities.abilities = d.abilities;
    capabilities.max_force = d.max_force;
    capabilities.max_torque = d.max_torque;
    capabilities.max_stiffness = d.max_stiffness;
    capabilities.max_rotation_stiffness = d.max_rotation_stiffness;
    capabilities.workspace_radius = d.workspace_radius;
    return capabilities;
}

}  // namespace bonemill
