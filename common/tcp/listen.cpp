#include "common/tcp/listen.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "common/base/user_error.h"
#include "common/tcp/descriptor.h"

namespace bonemill {
namespace {

constexpr char kMapped[] = "\0\0\0\0\0\0\0\0\0\0\xff\xff";
constexpr size_t kMappedBytes = sizeof kMapped - 1;

std::string whyNot(int error, uint16_t port) {
    switch (error) {
        case EACCES:
            return "this user may not open the port (those below 1024 are root's); take a higher one, such "
                   "as "
                   "8443, or type: sudo sysctl net.ipv4.ip_unprivileged_port_start=" +
                   std::to_string(port);
        case EADDRINUSE:
            return "another program has this port; stop it (ss -ltnp shows it), or take another port";
        case EADDRNOTAVAIL:
            return "this PC has no such address; ip -brief address shows those that it has";
        default:
            return std::strerror(error);
    }
}

}  // namespace

PeerAddress peerAddressOf(const sockaddr_storage& address) {
    PeerAddress peer{};
    if (address.ss_family == AF_INET6) {
        std::memcpy(peer.data(), &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, peer.size());
    } else {
        std::memcpy(peer.data(), kMapped, kMappedBytes);
        std::memcpy(peer.data() + kMappedBytes, &reinterpret_cast<const sockaddr_in&>(address).sin_addr,
                    peer.size() - kMappedBytes);
    }
    return peer;
}

std::string textOf(const PeerAddress& address) {
    char text[INET6_ADDRSTRLEN] = "?";
    if (std::memcmp(address.data(), kMapped, kMappedBytes) == 0) {
        inet_ntop(AF_INET, address.data() + kMappedBytes, text, sizeof text);
    } else {
        inet_ntop(AF_INET6, address.data(), text, sizeof text);
    }
    return text;
}

bool isLoopback(std::string_view address) {
    return address.starts_with("127.") || address == "::1";
}

Descriptor listenOn(const std::string& address, uint16_t port) {
    addrinfo wish{}, *found = nullptr;
    wish.ai_socktype = SOCK_STREAM;
    wish.ai_flags = AI_PASSIVE | AI_NUMERICHOST;
    if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &wish, &found) != 0)
        throw UserError("cannot listen on " + address +
                        ": this is a name, or no address. Give an address of this "
                        "PC (ip -brief address shows them), or 0.0.0.0 for all");
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
    Descriptor made(socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const int on = 1;
    setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (!made || bind(made.get(), found->ai_addr, found->ai_addrlen) != 0 ||
        listen(made.get(), SOMAXCONN) != 0)
        throw UserError("cannot listen on " + address + " port " + std::to_string(port) + ": " +
                        whyNot(errno, port));
    return made;
}

uint16_t portOf(int socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

Descriptor acceptFrom(int listener, PeerAddress& from) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    Descriptor socket(
        accept4(listener, reinterpret_cast<sockaddr*>(&address), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) return socket;
    setUpLine(socket.get());
    from = peerAddressOf(address);
    return socket;
}

size_t allowDescriptors(size_t count) {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= count) return count;
    const rlim_t before = limit.rlim_cur;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, count);
    return setrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : before;
}

}  // namespace bonemill
