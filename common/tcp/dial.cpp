#include "common/tcp/dial.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <memory>

#include "common/tcp/descriptor.h"

namespace bonemill {
namespace {

using DialClock = std::chrono::steady_clock;

Descriptor beginConnect(const sockaddr* address, socklen_t size) {
    Descriptor made(socket(address->sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!made) return {};
    setUpLine(made.get());
    if (connect(made.get(), address, size) != 0 && errno != EINPROGRESS) return {};
    return made;
}

}  // namespace

Dialled dial(const std::string& host, uint16_t port, std::chrono::milliseconds patience, int wake) {
    addrinfo wish{}, *found = nullptr;
    wish.ai_socktype = SOCK_STREAM;
    const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wish, &found);
    if (error != 0) return {{}, gai_strerror(error)};
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
    int left = 0;
    for (const addrinfo* at = found; at; at = at->ai_next) ++left;
    const auto end = DialClock::now() + patience;
    for (const addrinfo* at = found; at; at = at->ai_next, --left) {
        Descriptor socket = beginConnect(at->ai_addr, at->ai_addrlen);
        if (!socket) continue;
        const auto share =
            std::chrono::ceil<std::chrono::milliseconds>((end - DialClock::now()) / left).count();
        pollfd waits[] = {{socket.get(), POLLOUT, 0}, {wake, POLLIN, 0}};
        poll(waits, 2, int(std::max<int64_t>(share, 0)));
        if (waits[1].revents != 0) return {{}, "nobody waits for it any more"};
        if (waits[0].revents != 0 && hasConnected(socket.get())) return {std::move(socket), ""};
    }
    return {{}, "nobody answers there"};
}

Descriptor beginDialAsOf(int socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return {};
    return beginConnect(reinterpret_cast<const sockaddr*>(&address), size);
}

bool hasConnected(int socket) {
    int error = 0;
    socklen_t size = sizeof error;
    return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
}

}  // namespace bonemill
