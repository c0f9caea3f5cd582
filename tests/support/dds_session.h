// Keeps parallel test runs on one machine apart: a domain and a session of this process' own.
#pragma once

#include <unistd.h>

#include <cstdint>

namespace bonemill {

// The ports of domains from 102 on are among those that the kernel gives to any socket: they may be taken.
inline uint32_t testDomain() {
    return 20 + static_cast<uint32_t>(getpid()) % 80;
}
// Two processes may share a domain (80 of them), never a session.
inline uint32_t testSession() {
    return static_cast<uint32_t>(getpid());
}

}  // namespace bonemill
