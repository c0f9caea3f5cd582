#include "haptic_server/recording/statistics/tick_times.h"

#include <algorithm>
#include <cmath>

#include "common/rt/clock.h"

namespace bonemill {

TickTimes timesOf(std::vector<int64_t> durations_ns) {
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
