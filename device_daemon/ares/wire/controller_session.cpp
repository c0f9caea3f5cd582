#include "device_daemon/ares/wire/controller_session.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "device_daemon/ares/wire/packets.h"

namespace bonemill::wire {
namespace {

constexpr int64_t kNsPerAgeUnit = 10 * kNsPerMicrosecond;

// A host that is silent then has left its motors on.
bool isArmed(DriveState state) noexcept {
    return state == DriveState::kReady || state == DriveState::kSwitchedOn ||
           state == DriveState::kOperationEnabled || state == DriveState::kQuickStop;
}

}  // namespace

template <class Packets>
ControllerSession<Packets>::ControllerSession(const Describe& description, const Handle& handle) noexcept
    : description_(description), handle_(handle), own_watchdog_us_(description.watchdog_us) {}

template <class Packets>
Taken ControllerSession<Packets>::take(std::span<const std::byte> bytes, const Endpoint& source,
                                       int64_t now_ns) noexcept {
    return claimedType(bytes) == PacketType::kDescribeRequest ? takeRequest(bytes, source, now_ns)
                                                              : takeCommand(bytes, source, now_ns);
}

template <class Packets>
Taken ControllerSession<Packets>::takeRequest(std::span<const std::byte> bytes, const Endpoint& source,
                                              int64_t now_ns) noexcept {
    const auto request = open<DescribeRequest>(bytes);
    if (!request) {
        flow_.reject(has_host_ && source == host_);
        return Taken::kNothing;
    }
    const bool is_host = has_host_ && source == host_;
    const bool is_of_session = is_host && request->header.session == session_;
    if (is_of_session) {  // the answer was lost
        return flow_.skip(request->header.sequence) ? Taken::kRequest : Taken::kNothing;
    }
    // A host that is silent may ask again until it is forgotten; a stranger shall not be quicker. While the
    // drive is armed, the watchdog has yet to say that the host is silent.
    const bool is_taken = has_host_ && !(is_host && isSilent(now_ns));
    if (is_taken || isArmed(drive_.state())) {
        flow_.reject(false);
        return Taken::kNothing;
    }
    adopt(*request, source, now_ns);
    return Taken::kRequest;
}

template <class Packets>
void ControllerSession<Packets>::adopt(const DescribeRequest& request, const Endpoint& source,
                                       int64_t now_ns) noexcept {
    has_host_ = true;
    host_ = source;
    session_ = request.header.session;
    understands_ = request.understands;
    heard_ns_ = now_ns;
    has_command_ = false;
    command_ = {};
    lost_before_ = flow_.statistics().lost;
    description_.watchdog_us = request.watchdog_us == 0
                                   ? own_watchdog_us_
                                   : std::clamp(request.watchdog_us, kShortestWatchdogUs, kLongestWatchdogUs);
    drive_.disable();
    const uint32_t rate_hz = std::max(description_.rate_hz, 1u);
    // The host can reflect the description, which is sent next, and whatever follows.
    flow_.begin(request.header.sequence, sequence_ + 1, kNsPerSecond / rate_hz, now_ns);
}

template <class Packets>
Taken ControllerSession<Packets>::takeCommand(std::span<const std::byte> bytes, const Endpoint& source,
                                              int64_t now_ns) noexcept {
    const bool is_from_host = has_host_ && source == host_;
    const auto command = is_from_host ? open<Command>(bytes) : std::nullopt;
    if (!command || command->header.session != session_) {
        flow_.reject(is_from_host);
        return Taken::kNothing;
    }
    if (!flow_.accept(command->header.sequence, command->reflected_sequence, sequence_,
                      int64_t(command->host_ns), now_ns)) {
        return Taken::kNothing;
    }
    command_ = *command;
    has_command_ = true;
    heard_ns_ = now_ns;
    drive_.command(command_.controlword, flow_.isTrusted());
    return Taken::kCommand;
}

template <class Packets>
void ControllerSession<Packets>::step(uint32_t device_faults, bool is_powered, int64_t now_ns) noexcept {
    const uint32_t link_faults = linkFaults(now_ns);
    if ((link_faults & kFaultWatchdog) && !(drive_.activeFaults() & kFaultWatchdog)) ++watchdog_trips_;
    drive_.report(device_faults | link_faults, is_powered);
    if (has_host_ && now_ns - heard_ns_ > kForgetHostAfterNs) has_host_ = false;
}

// Silence of a host that has switched off, or of none, is no fault; one that has tripped goes on until a
// command comes.
template <class Packets>
uint32_t ControllerSession<Packets>::linkFaults(int64_t now_ns) const noexcept {
    const bool was_tripped = drive_.activeFaults() & kFaultWatchdog;
    const bool was_late = drive_.activeFaults() & kFaultLatePackets;
    const bool is_armed = isArmed(drive_.state());
    uint32_t faults = 0;
    if ((is_armed || was_tripped) && isSilent(now_ns)) faults |= kFaultWatchdog;
    if ((is_armed || was_late) && flow_.tooManyLate()) faults |= kFaultLatePackets;
    return faults;
}

template <class Packets>
bool ControllerSession<Packets>::isSilent(int64_t now_ns) const noexcept {
    return !has_host_ || now_ns - heard_ns_ > description_.watchdog_us * kNsPerMicrosecond;
}

template <class Packets>
auto ControllerSession<Packets>::commandInForce(int64_t now_ns) const noexcept -> const Command* {
    const bool may_flow = drive_.state() == DriveState::kOperationEnabled && has_command_ &&
                          !isSilent(now_ns) && command_.mode == kModeTorque;
    const bool has_lapsed =
        command_.valid_for_us != 0 && now_ns - heard_ns_ > int64_t(command_.valid_for_us) * kNsPerMicrosecond;
    return may_flow && !has_lapsed ? &command_ : nullptr;
}

template <class Packets>
std::span<const std::byte> ControllerSession<Packets>::sealDescription() noexcept {
    if (understands_ & kUnderstandsHandle) {
        long_description_ = {.describe = description_, .handle = handle_, .reserved0 = 0, .crc = 0};
        long_description_.describe.crc = 0;
        wire::seal(long_description_, session_, ++sequence_);
        return bytesOf(long_description_);
    }
    wire::seal(description_, session_, ++sequence_);
    return bytesOf(description_);
}

template <class Packets>
void ControllerSession<Packets>::seal(State& state, int64_t now_ns) noexcept {
    constexpr int64_t kOldest = std::numeric_limits<uint16_t>::max();
    const int64_t age = has_command_ ? (now_ns - heard_ns_) / kNsPerAgeUnit : kOldest;
    state.reflected_sequence = flow_.newestSequence();
    state.controller_ns = uint64_t(now_ns);
    state.statusword = drive_.statusword();
    state.first_fault = drive_.firstFault();
    state.active_faults = drive_.activeFaults();
    state.command_age_10us = uint16_t(std::clamp<int64_t>(age, 0, kOldest));
    state.lost_commands = uint16_t(flow_.statistics().lost - lost_before_);
    wire::seal(state, session_, ++sequence_);
}

template class ControllerSession<JointPackets>;
template class ControllerSession<PosePackets>;

template <class Packets>
bool ControllerLink<Packets>::poll(int64_t now_ns) noexcept {
    bool has_command = false;
    for (int i = 0; i < kDatagramsAtOnce; ++i) {
        std::array<std::byte, kMaxPacket> buffer;
        Endpoint source;
        int64_t waited_ns = 0;
        const auto bytes = socket_.receive(buffer, source, &waited_ns);
        if (bytes.empty()) break;
        if (only_host_ && source != *only_host_) continue;  // it came before the kernel knew
        const Taken taken = session_.take(bytes, source, now_ns - waited_ns);
        if (taken == Taken::kRequest) socket_.send(session_.sealDescription(), session_.host());
        has_command |= taken == Taken::kCommand;
    }
    keepStrangersOut();
    return has_command;
}

// No other sender is listened to while there is a host, so none may stand in its way either.
template <class Packets>
void ControllerLink<Packets>::keepStrangersOut() noexcept {
    const auto host = session_.hasHost() ? std::optional(session_.host()) : only_host_;
    if (host == admitted_) return;
    socket_.admitOnly(host);
    admitted_ = host;
}

template <class Packets>
bool ControllerLink<Packets>::waitForCommand(int64_t deadline_ns) noexcept {
    while (true) {
        const int64_t now_ns = monotonicNowNs();
        if (poll(now_ns)) return true;
        if (now_ns >= deadline_ns) return false;
        socket_.waitUntil(deadline_ns);
    }
}

template <class Packets>
bool ControllerLink<Packets>::send(State& state, int64_t now_ns) noexcept {
    if (!session_.hasHost()) return false;
    session_.seal(state, now_ns);
    return socket_.send(bytesOf(state), session_.host());
}

template class ControllerLink<JointPackets>;
template class ControllerLink<PosePackets>;

}  // namespace bonemill::wire
