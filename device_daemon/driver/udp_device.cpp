#include "device_daemon/driver/udp_device.h"

#include "common/rt/clock.h"
#include "device_daemon/driver/wire_status.h"
#include "device_daemon/wire/drive_state.h"

namespace bonemill {
namespace {

// An order to reset is said so often, because packets get lost. The controller acts on the first.
constexpr int kResetRepeats = 10;

}  // namespace

template <class Packets>
auto UdpDevice<Packets>::read() noexcept -> const State* {
    const int64_t now_ns = monotonicNowNs();
    link_.poll(now_ns);
    return session().hasState() && !session().isLost(now_ns) ? &session().state() : nullptr;
}

template <class Packets>
uint32_t UdpDevice<Packets>::status() const noexcept {
    const State& state = session().state();
    return deviceStatusOf(state.inputs, state.statusword, session().isTrusted());
}

template <class Packets>
StopCause UdpDevice<Packets>::fault() const noexcept {
    const State& state = session().state();
    const uint32_t faults = state.first_fault != 0 ? state.first_fault : state.active_faults;
    if (faults != 0) return stopCauseOf(faults);
    if (wire::driveStateOf(state.statusword) == wire::DriveState::kFault) return StopCause::kDeviceFault;
    return session().tooManyLate() ? StopCause::kLatePackets : StopCause::kNone;
}

template <class Packets>
void UdpDevice<Packets>::write(Command& command, const Wish& wish) noexcept {
    const State& state = session().state();
    const bool must_home = wish.is_wanted && !(state.inputs & wire::kInputHomed);
    command.flags = wish.is_engaged ? wire::kCommandEngaged | wire::kCommandAttached : 0;
    command.controlword = controlword(wish);
    command.mode = must_home ? wire::kModeHoming : wire::kModeTorque;
    command.enabling_echo = state.inputs & wire::kInputEnabled;
    link_.send(command, monotonicNowNs());
}

template <class Packets>
uint16_t UdpDevice<Packets>::controlword(const Wish& wish) noexcept {
    const wire::DriveState state = wire::driveStateOf(session().state().statusword);
    if (wish.reset) resets_left_ = kResetRepeats;
    if (resets_left_ > 0 && state == wire::DriveState::kFault) {
        --resets_left_;
        return wire::kControlFaultReset;
    }
    resets_left_ = 0;
    return wire::controlwordTowards(wish.is_wanted && session().isTrusted(), state);
}

template class UdpDevice<wire::JointPackets>;
template class UdpDevice<wire::PosePackets>;

}  // namespace bonemill
