// Keeps parallel test runs on one machine apart: a domain and a session of this process' own.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>

namespace bonemill {

// The ports of domains from 102 on are among those that the kernel gives to any socket: they may be taken.
inline constexpr uint32_t kFirstTestDomain = 20, kTestDomains = 80;

// Returns whether no other process has this domain. A socket's name says so for as long as this one lives.
inline bool claimDomain(uint32_t domain) {
    sockaddr_un name{.sun_family = AF_UNIX, .sun_path = {}};
    std::snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "bonemill_test_domain_%u", domain);
    const int claim = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (bind(claim, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0) return true;
    close(claim);
    return false;
}

inline uint32_t testDomain() {
    static const uint32_t domain = [] {
        uint32_t candidate = 0;
        for (uint32_t n = 0; n < kTestDomains; ++n) {
            candidate = kFirstTestDomain + (static_cast<uint32_t>(getpid()) + n) % kTestDomains;
            if (claimDomain(candidate)) break;
        }
        return candidate;
    }();
    return domain;
}
inline uint32_t testSession() {
    return static_cast<uint32_t>(getpid());
}

}  // namespace bonemill
