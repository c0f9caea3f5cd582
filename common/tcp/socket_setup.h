// What every TCP line of ours has in common: small things go at once, and a line whose other end has lost its
// power or its network is missed within a minute, whether something is to be said there or not.
#pragma once

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace bonemill {

inline void setUpLine(int socket) noexcept {
    constexpr int kOn = 1, kIdle_s = 30, kInterval_s = 10, kProbes = 3, kUnheard_ms = 60000;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
    setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &kOn, sizeof kOn);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &kIdle_s, sizeof kIdle_s);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &kInterval_s, sizeof kInterval_s);
    setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &kProbes, sizeof kProbes);
    setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &kUnheard_ms, sizeof kUnheard_ms);
}

}  // namespace bonemill
