#include "render_client/relay/dial.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "common/user_error.h"

namespace bonemill {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses addressesOf(const std::string& host, uint16_t port, int flags) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags;
    addrinfo* found = nullptr;
    if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) found = nullptr;
    return {found, &freeaddrinfo};
}

// Small things are to go at once, and a line whose other end lost its power is to be missed some day.
void setUp(int socket) {
    const int on = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
}

std::string textOfAddress(const sockaddr_storage& address, socklen_t size) {
    char text[NI_MAXHOST] = "?";
    getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, text, sizeof text, nullptr, 0,
                NI_NUMERICHOST);
    return text;
}

}  // namespace

Descriptor listenOn(const std::string& address, uint16_t port) {
    const Addresses addresses = addressesOf(address, port, AI_PASSIVE | AI_NUMERICHOST);
    if (!addresses) throw UserError(address + ": this is no address of a network; 0.0.0.0 stands for all");
    Descriptor made(socket(addresses->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const int on = 1;
    setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (!made || bind(made.get(), addresses->ai_addr, addresses->ai_addrlen) != 0 ||
        listen(made.get(), SOMAXCONN) != 0)
        throw UserError("cannot listen on " + address + " port " + std::to_string(port) + ": " +
                        std::strerror(errno));
    return made;
}

uint16_t portOf(int socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

Descriptor acceptFrom(int listener, std::string& address) {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    Descriptor socket(
        accept4(listener, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) return socket;
    setUp(socket.get());
    address = textOfAddress(from, size);
    return socket;
}

Descriptor beginDial(const std::string& host, uint16_t port) {
    const Addresses addresses = addressesOf(host, port, AI_ADDRCONFIG);
    if (!addresses) return {};
    Descriptor made(socket(addresses->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!made) return {};
    setUp(made.get());
    if (connect(made.get(), addresses->ai_addr, addresses->ai_addrlen) != 0 && errno != EINPROGRESS)
        return {};
    return made;
}

size_t allowDescriptors(size_t count) {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= count) return count;
    const rlim_t before = limit.rlim_cur;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, count);
    return setrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : before;
}

}  // namespace bonemill
