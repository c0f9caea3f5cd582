// Keeps parallel test runs on one machine apart: a domain and a session of this process' own.
#pragma once

#include <unistd.h>

#include <cstdint>

namespace bonemill {

inline uint32_t testDomain() {
    return 20 + static_cast<uint32_t>(getpid()) % 180;
}
// Two processes may share a domain (180 of them), never a session.
inline uint32_t testSession() {
    return static_cast<uint32_t>(getpid());
}

}  // namespace bonemill
