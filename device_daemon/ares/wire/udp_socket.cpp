#include "device_daemon/ares/wire/udp_socket.h"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <utility>

#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill::wire {
namespace {

sockaddr_in socketAddressOf(const Endpoint& endpoint) noexcept {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(endpoint.port);
    address.sin_addr.s_addr = htonl(endpoint.address);
    return address;
}

Endpoint endpointOf(const sockaddr_in& address) noexcept {
    return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

// The kernel stamps with the clock that people set, so that a stamp may be of any time.
int64_t waitedNs(const msghdr& message) noexcept {
    constexpr int64_t kLongestNs = 50 * kNsPerMillisecond;
    const cmsghdr* header = CMSG_FIRSTHDR(&message);
    if (!header || header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_TIMESTAMPNS) return 0;
    timespec came{}, now{};
    std::memcpy(&came, CMSG_DATA(header), sizeof(came));
    clock_gettime(CLOCK_REALTIME, &now);
    const int64_t waited_ns = int64_t(now.tv_sec - came.tv_sec) * kNsPerSecond + now.tv_nsec - came.tv_nsec;
    return waited_ns > 0 && waited_ns <= kLongestNs ? waited_ns : 0;
}

}  // namespace

Endpoint endpointOf(const std::string& address, uint16_t port) {
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
        throw UserError("'" + address + "' is no IPv4 address: write four numbers such as 192.168.1.20");
    }
    return {ntohl(parsed.s_addr), port};
}

std::string textOf(const Endpoint& endpoint) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) {
        text += std::to_string((endpoint.address >> shift) & 0xff) + (shift > 0 ? "." : ":");
    }
    return text + std::to_string(endpoint.port);
}

UdpSocket::UdpSocket(const Endpoint& local)
    : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const sockaddr_in wanted = socketAddressOf(local);
    sockaddr_in bound{};
    socklen_t size = sizeof(bound);
    if (descriptor_ >= 0 &&
        bind(descriptor_, reinterpret_cast<const sockaddr*>(&wanted), sizeof(wanted)) == 0 &&
        getsockname(descriptor_, reinterpret_cast<sockaddr*>(&bound), &size) == 0) {
        local_ = endpointOf(bound);
        constexpr int kOn = 1;
        setsockopt(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, &kOn, sizeof(kOn));
        return;
    }
    const std::string reason = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    throw UserError("cannot listen on UDP " + textOf(local) + " (" + reason +
                    "): choose an address of this machine and a port that nobody uses");
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), local_(other.local_) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    std::swap(local_, other.local_);
    return *this;
}

UdpSocket::~UdpSocket() {
    if (descriptor_ >= 0) close(descriptor_);
}

std::span<const std::byte> UdpSocket::receive(std::span<std::byte> buffer, Endpoint& source,
                                              int64_t* waited_ns) noexcept {
    sockaddr_in from{};
    iovec place{buffer.data(), buffer.size()};
    alignas(cmsghdr) std::byte control[CMSG_SPACE(sizeof(timespec))];
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof(from);
    message.msg_iov = &place;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof(control);
    const ssize_t length = recvmsg(descriptor_, &message, 0);
    if (length <= 0) return {};
    source = endpointOf(from);
    if (waited_ns) *waited_ns = waitedNs(message);
    return buffer.first(std::min(size_t(length), buffer.size()));
}

bool UdpSocket::send(std::span<const std::byte> bytes, const Endpoint& to) noexcept {
    const sockaddr_in address = socketAddressOf(to);
    const ssize_t sent = sendto(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address), sizeof(address));
    return sent == ssize_t(bytes.size());
}

// The filter's bytes are those of the UDP header, and SKF_NET_OFF leads to the IP header before it.
void UdpSocket::admitOnly(const std::optional<Endpoint>& source) noexcept {
    if (!source) {
        constexpr int kUnused = 0;
        setsockopt(descriptor_, SOL_SOCKET, SO_DETACH_FILTER, &kUnused, sizeof(kUnused));
        return;
    }
    constexpr uint32_t kSourceAddress = uint32_t(SKF_NET_OFF) + 12, kSourcePort = 0, kAll = UINT32_MAX;
    sock_filter steps[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kSourceAddress),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, source->address, 0, 3),
        BPF_STMT(BPF_LD | BPF_H | BPF_ABS, kSourcePort),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, source->port, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, kAll),
        BPF_STMT(BPF_RET | BPF_K, 0),
    };
    const sock_fprog program{std::size(steps), steps};
    setsockopt(descriptor_, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program));
}

bool UdpSocket::waitUntil(int64_t deadline_ns) noexcept {
    pollfd socket_event{descriptor_, POLLIN, 0};
    while (true) {
        const timespec left = timespecOfNs(std::max<int64_t>(0, deadline_ns - monotonicNowNs()));
        const int ready = ppoll(&socket_event, 1, &left, nullptr);
        if (ready > 0) return true;
        if (ready == 0 || errno != EINTR) return false;
    }
}

}  // namespace bonemill::wire
