// Measures how long the server's cuts take until the viewer has them, and until a picture shows them. It is
// for one thread.
//
// The stamps are the server's CLOCK_REALTIME: between machines the figures are as good as their clocks.
#pragma once

#include <chrono>
#include <cstdint>
#include <set>

#include "common/rt/latency_histogram.h"

namespace bonemill {

class CutToScreen {
  public:
    static int64_t nowNs() {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
    }

    // The viewer has the first node of a group with this stamp (NodeTag::cut_stamp_ns; 0 means no cut) now,
    // in ns of CLOCK_REALTIME; the next picture shows it. Stamps of another time are left out.
    void willShow(int64_t cut_stamp_ns, int64_t now_ns) {
        if (cut_stamp_ns <= 0 || cut_stamp_ns > now_ns ||
            cut_stamp_ns <= now_ns - LatencyHistogram::kLargestNs)
            return;
        if (stamps_ns_.insert(cut_stamp_ns).second) arrivals_.record(now_ns - cut_stamp_ns);
    }
    // That picture is finished now.
    void hasShown(int64_t now_ns) {
        for (const int64_t stamp_ns : stamps_ns_) times_.record(now_ns - stamp_ns);
        stamps_ns_.clear();
    }
    // There is one time for each group of nodes that was published.
    const LatencyHistogram& arrivals() const { return arrivals_; }
    const LatencyHistogram& times() const { return times_; }

  private:
    std::set<int64_t> stamps_ns_;  // of what the next picture shows
    LatencyHistogram arrivals_, times_;
};

}  // namespace bonemill
