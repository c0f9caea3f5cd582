// Tells how long the ticks of a run took, in µs. It is not RT-safe.
#pragma once

#include <cstdint>
#include <vector>

namespace bonemill {

struct TickTimes {
    double p50 = 0, p99 = 0, p99_9 = 0, max = 0;  // µs
};

// The percentiles are durations of the list itself (nearest rank); all are 0 for an empty list.
TickTimes timesOf(std::vector<int64_t> durations_ns);

}  // namespace bonemill
