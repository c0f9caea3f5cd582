// How long the server's cuts take until a picture shows them. One thread.
//
// The stamps are the server's CLOCK_REALTIME: between machines the figures are as good as their clocks.
#pragma once

#include <cstdint>
#include <vector>

#include "common/rt/latency_histogram.h"

namespace bonemill {

class CutToScreen {
  public:
    // The next picture shows a node with a cut that began then (NodeTag::cut_stamp_ns; 0: no cut).
    void willShow(int64_t cut_stamp_ns) {
        if (cut_stamp_ns != 0) stamps_ns_.push_back(cut_stamp_ns);
    }
    // That picture is finished: now, in ns of CLOCK_REALTIME.
    void hasShown(int64_t now_ns) {
        for (const int64_t stamp_ns : stamps_ns_) times_.record(now_ns - stamp_ns);
        stamps_ns_.clear();
    }
    const LatencyHistogram& times() const { return times_; }
    void forget() { *this = {}; }

  private:
    std::vector<int64_t> stamps_ns_;
    LatencyHistogram times_;
};

}  // namespace bonemill
