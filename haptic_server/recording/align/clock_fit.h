// One clock by another: the straight line that fits pairs of readings best. Pure; any thread may call it.
#pragma once

#include <cstddef>
#include <span>

namespace bonemill {

// What both clocks read at one moment.
struct ClockPair {
    double foreign = 0;  // in its own unit
    double session_s = 0;
};

struct ClockFit {
    double foreign_mean = 0, session_mean_s = 0;
    double rate = 1;  // s of the session per unit of the foreign clock
    size_t pairs = 0;
    double rms_s = 0, max_s = 0;  // by how much pairs lie beside the line

    double sessionOf(double foreign) const { return session_mean_s + rate * (foreign - foreign_mean); }
};

// Least squares of offset and rate. A single pair, or pairs of one foreign moment, give the offset alone: the
// clock then counts seconds that are the session's. There is at least one pair.
ClockFit fitClock(std::span<const ClockPair> pairs);

}  // namespace bonemill
