#include "device_daemon/ares/wire/drive_state.h"

#include "device_daemon/ares/wire/packets.h"

namespace bonemill::wire {
namespace {

constexpr uint16_t kVoltageEnabled = 1u << 4;
constexpr uint16_t kRemote = 1u << 9;

constexpr uint16_t kControlVoltageBit = 1u << 1;
constexpr uint16_t kControlNoQuickStopBit = 1u << 2;
constexpr uint16_t kControlCommandBits = 0x0F;

bool isOn(DriveState state) noexcept {
    return state == DriveState::kSwitchedOn || state == DriveState::kOperationEnabled;
}

DriveState afterCommand(DriveState state, uint16_t controlword, bool may_enable) noexcept {
    if (state == DriveState::kNotReady || state == DriveState::kFault) return state;
    if (!(controlword & kControlVoltageBit)) return DriveState::kSwitchOnDisabled;
    if (!(controlword & kControlNoQuickStopBit)) {
        const bool gives_force = state == DriveState::kOperationEnabled || state == DriveState::kQuickStop;
        return gives_force ? DriveState::kQuickStop : DriveState::kSwitchOnDisabled;
    }
    if (state == DriveState::kQuickStop) return state;  // it is left by "disable" only
    switch (controlword & kControlCommandBits) {
        case kControlShutdown:
            return DriveState::kReady;
        case kControlSwitchOn:
            return state == DriveState::kReady || isOn(state) ? DriveState::kSwitchedOn : state;
        case kControlEnable:
            if (state == DriveState::kReady) return DriveState::kSwitchedOn;
            return isOn(state) && may_enable ? DriveState::kOperationEnabled : state;
        default:
            return state;
    }
}

}  // namespace

uint16_t statuswordOf(DriveState state) noexcept {
    switch (state) {
        case DriveState::kNotReady:
            return 0x00;
        case DriveState::kSwitchOnDisabled:
            return 0x40;
        case DriveState::kReady:
            return 0x21;
        case DriveState::kSwitchedOn:
            return 0x23;
        case DriveState::kOperationEnabled:
            return 0x27;
        case DriveState::kQuickStop:
            return 0x07;
        case DriveState::kFault:
            return 0x08;
    }
    return 0x08;
}

DriveState driveStateOf(uint16_t statusword) noexcept {
    if (statusword & 0x08) return DriveState::kFault;
    if (statusword & 0x40) return DriveState::kSwitchOnDisabled;
    for (const DriveState state : {DriveState::kReady, DriveState::kSwitchedOn, DriveState::kOperationEnabled,
                                   DriveState::kQuickStop}) {
        if ((statusword & 0x6F) == statuswordOf(state)) return state;
    }
    return DriveState::kNotReady;
}

uint16_t controlwordTowards(bool is_wanted, DriveState state) noexcept {
    if (!is_wanted) return kControlDisable;
    switch (state) {
        case DriveState::kSwitchOnDisabled:
            return kControlShutdown;
        case DriveState::kReady:
            return kControlSwitchOn;
        case DriveState::kSwitchedOn:
        case DriveState::kOperationEnabled:
            return kControlEnable;
        default:
            return kControlDisable;
    }
}

uint16_t DriveStateMachine::statusword() const noexcept {
    return uint16_t(statuswordOf(state_) | (is_powered_ ? kVoltageEnabled : 0) | kRemote);
}

void DriveStateMachine::command(uint16_t controlword, bool may_enable) noexcept {
    const bool resets = (controlword & kControlFaultReset) && !(last_controlword_ & kControlFaultReset);
    last_controlword_ = controlword;
    if (state_ == DriveState::kFault) {
        if (!resets || active_faults_ != 0) return;
        first_fault_ = 0;
        state_ = DriveState::kSwitchOnDisabled;
        return;
    }
    state_ = afterCommand(state_, controlword, may_enable && is_powered_);
}

void DriveStateMachine::report(uint32_t faults, bool is_powered) noexcept {
    active_faults_ = faults;
    is_powered_ = is_powered;
    if (faults != 0) {
        if (state_ != DriveState::kFault) first_fault_ = faults;
        state_ = DriveState::kFault;
    } else if (state_ == DriveState::kNotReady) {
        state_ = DriveState::kSwitchOnDisabled;
    } else if (!is_powered) {
        disable();
    }
}

void DriveStateMachine::disable() noexcept {
    if (state_ == DriveState::kNotReady || state_ == DriveState::kFault) return;
    state_ = DriveState::kSwitchOnDisabled;
}

}  // namespace bonemill::wire
