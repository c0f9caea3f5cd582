#include "device_daemon/ares/driver/udp_device.h"

#include <utility>

#include "common/rt/clock.h"
#include "device_daemon/ares/driver/wire_status.h"
#include "device_daemon/ares/wire/drive_state.h"

namespace bonemill {
namespace {

// An order to reset is said so often, because packets get lost. The controller acts on the first that comes.
constexpr int kResetRepeats = 10;

}  // namespace

template <class Packets>
auto UdpDevice<Packets>::read() noexcept -> const State* {
    const int64_t now_ns = monotonicNowNs();
    link_.poll(now_ns);
    told_fault_ = std::exchange(newest_fault_, session().state().first_fault);
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
    if (newest_fault_ != 0 && newest_fault_ != told_fault_) return stopCauseOf(newest_fault_);
    uint32_t faults = state.first_fault | state.active_faults;
    const bool has_fault = wire::driveStateOf(state.statusword) == wire::DriveState::kFault;
    if (has_fault && faults == 0) faults = wire::kFaultInternal;
    if (session().tooManyLate()) faults |= wire::kFaultLatePackets;
    return stopCauseOf(faults);
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
    // What has not gone yet is not reset: whoever wants it asks again.
    const bool is_over = state == wire::DriveState::kFault && session().state().active_faults == 0;
    if (wish.reset) resets_left_ = kResetRepeats;
    if (!is_over) resets_left_ = 0;
    if (resets_left_ > 0) {
        --resets_left_;
        return wire::kControlFaultReset;
    }
    return wire::controlwordTowards(wish.is_wanted && session().isTrusted(), state);
}

template class UdpDevice<wire::JointPackets>;
template class UdpDevice<wire::PosePackets>;

}  // namespace bonemill
