// Tells how long the ticks of a run took, in µs. It is not RT-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/rt/clock.h"

namespace bonemill {

struct TickTimes {
    double p50 = 0, p99 = 0, p99_9 = 0, max = 0;  // µs
};

// The percentiles are durations of the list itself (nearest rank); all are 0 for an empty list.
inline TickTimes timesOf(std::vector<int64_t> durations_ns) {
    if (durations_ns.empty()) return {};
    std::sort(durations_ns.begin(), durations_ns.end());
    constexpr double kRounding = 1e-9;
    const auto us = [&](double percent) {
        const auto rank = size_t(std::ceil(percent / 100 * double(durations_ns.size()) - kRounding));
        return microsecondsOfNs(double(durations_ns[std::max<size_t>(rank, 1) - 1]));
    };
    return {us(50), us(99), us(99.9), us(100)};
}

}  // namespace bonemill
