#include "device_daemon/ares/wire/host_link.h"

#include <algorithm>
#include <array>
#include <random>

#include "common/rt/clock.h"

namespace bonemill::wire {

uint64_t randomSeed() {
    std::random_device device;
    return (uint64_t(device()) << 32) | device();
}

template <class Packets>
bool HostLink<Packets>::waitForState(int64_t deadline_ns) noexcept {
    while (true) {
        const int64_t now_ns = monotonicNowNs();
        if (poll(now_ns)) return true;
        if (now_ns >= deadline_ns) return false;
        socket_.waitUntil(std::min(deadline_ns, now_ns + kAskEveryNs));
    }
}

template <class Packets>
bool HostLink<Packets>::poll(int64_t now_ns) noexcept {
    bool has_new = false;
    for (int i = 0; i < kDatagramsAtOnce; ++i) {
        std::array<std::byte, kMaxPacket> buffer;
        Endpoint source;
        const auto bytes = socket_.receive(buffer, source);
        if (bytes.empty()) break;
        has_new |= session_.take(bytes, source, now_ns);
    }
    if (const DescribeRequest* request = session_.requestDue(now_ns)) {
        socket_.send(bytesOf(*request), session_.controller());
    }
    return has_new;
}

template <class Packets>
bool HostLink<Packets>::send(Command& command, int64_t now_ns) noexcept {
    return session_.seal(command, now_ns) && socket_.send(bytesOf(command), session_.controller());
}

template class HostLink<JointPackets>;
template class HostLink<PosePackets>;

}  // namespace bonemill::wire
