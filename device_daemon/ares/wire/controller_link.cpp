#include "device_daemon/ares/wire/controller_link.h"

#include <array>

#include "common/rt/clock.h"

namespace bonemill::wire {

template <class Packets>
bool ControllerLink<Packets>::poll(int64_t now_ns) noexcept {
    bool has_command = false;
    for (int i = 0; i < kDatagramsAtOnce; ++i) {
        std::array<std::byte, kMaxPacket> buffer;
        Endpoint source;
        const auto bytes = socket_.receive(buffer, source);
        if (bytes.empty()) break;
        if (only_host_ && source != *only_host_) continue;  // it came before the kernel knew
        const Taken taken = session_.take(bytes, source, now_ns);
        if (taken == Taken::kRequest) socket_.send(bytesOf(session_.sealDescription()), session_.host());
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
