// Who else is watching. It is bounded, whatever senders are invented: each participant speaks for few
// viewers, the last that it spoke for, and for none that another one speaks for; of too many the least recent
// goes of who has most. For one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {

class ViewerList {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kTimeout{4};
    static constexpr size_t kMaxViewers = 256;
    static constexpr size_t kMaxOfParticipant = 64;  // a gateway's guests

    // `participant` is who tells of this viewer (dds::Reader::participantOf).
    void hear(topics::Viewer viewer, uint64_t participant, Clock::time_point now);
    // Forgets those that were not heard within kTimeout.
    void forgetSilent(Clock::time_point now);
    // Returns them by sender.
    std::vector<topics::Viewer> viewers() const;

  private:
    struct Heard {
        topics::Viewer viewer;
        uint64_t participant = 0;
        Clock::time_point at;
    };
    std::map<uint64_t, Heard> heard_;  // by sender
};

}  // namespace bonemill
