// This is the one clock of the simulator: CLOCK_MONOTONIC, the same for all processes of one machine.
//
// It is RT-safe (vDSO, no system call), and any thread may read it.
#pragma once

#include <time.h>

#include <cmath>
#include <cstdint>

#include "common/base/units.h"

namespace bonemill {

inline int64_t monotonicNowNs() noexcept {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return int64_t(now.tv_sec) * kNsPerSecond + now.tv_nsec;
}

inline constexpr timespec timespecOfNs(int64_t ns) noexcept {
    return {time_t(ns / kNsPerSecond), long(ns % kNsPerSecond)};
}

// From one stamp to a later one of a clock outside, whose numbers may be any: a difference that does not fit
// wraps.
inline constexpr int64_t nsBetween(int64_t from_ns, int64_t to_ns) noexcept {
    return int64_t(uint64_t(to_ns) - uint64_t(from_ns));
}

// Of what a scene says.
inline int64_t nsOfMilliseconds(double ms) noexcept {
    return std::llround(ms * double(kNsPerMillisecond));
}

inline constexpr double secondsOfNs(int64_t ns) noexcept {
    return double(ns) / double(kNsPerSecond);
}

// It takes a mean or a difference too, hence no whole ns.
inline constexpr double millisecondsOfNs(double ns) noexcept {
    return ns / double(kNsPerMillisecond);
}

inline constexpr double microsecondsOfNs(double ns) noexcept {
    return ns / double(kNsPerMicrosecond);
}

}  // namespace bonemill
