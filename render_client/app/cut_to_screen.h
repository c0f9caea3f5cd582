// Measures how long the server's cuts take until a picture shows them. It is for one thread.
//
// The stamps are the server's CLOCK_REALTIME: between machines the figures are as good as their clocks.
#pragma once

#include <cstdint>
#include <set>

#include "common/rt/latency_histogram.h"

namespace bonemill {

class CutToScreen {
  public:
    // The next picture shows the first node of a group with this stamp
    // (NodeTag::cut_stamp_ns; 0 means no cut).
    void willShow(int64_t cut_stamp_ns) {
        if (cut_stamp_ns != 0) stamps_ns_.insert(cut_stamp_ns);
    }
    // That picture is finished now, in ns of CLOCK_REALTIME. Stamps of another time are left out.
    void hasShown(int64_t now_ns) {
        for (const int64_t stamp_ns : stamps_ns_)
            if (stamp_ns <= now_ns && stamp_ns > now_ns - LatencyHistogram::kLargestNs)
                times_.record(now_ns - stamp_ns);
        stamps_ns_.clear();
    }
    // There is one time for each group of nodes that was published.
    const LatencyHistogram& times() const { return times_; }

  private:
    std::set<int64_t> stamps_ns_;
    LatencyHistogram times_;
};

}  // namespace bonemill
