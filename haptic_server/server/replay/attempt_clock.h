// One clock for two recorded attempts: in both the same time has passed since the attempt began.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

class AttemptClock {
  public:
    // `shown` leads, with the attempt under way or, without any, the whole session; of `other` it is one
    // attempt. Both recordings must outlive this object.
    AttemptClock(const Recording& shown, const Recording& other, const RecordedAttempt& attempt);

    // The tick at which the other one stands while the first shows this tick: its first one before the
    // attempt has begun in the first, its last one when it has ended. Any thread.
    uint64_t otherTickAt(uint64_t shown_tick) const;
    // Of the other attempt: since it began, s.
    double attemptS(uint64_t other_tick) const;
    double lengthS() const { return attemptS(last_); }

  private:
    const Recording& shown_;
    const Recording& other_;
    std::vector<uint64_t> begins_;  // of the attempts that lead, at least one
    uint64_t first_, last_;         // ticks of the other attempt
};

}  // namespace bonemill
