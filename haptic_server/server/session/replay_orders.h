// Who shows a recorded session answers these instead of a live one (replay/player.h). The publisher thread
// calls all members; none waits.
#pragma once

#include "common/commands/answer.h"
#include "proto/topics.pb.h"

namespace bonemill {

class ReplayOrders {
  public:
    virtual ~ReplayOrders() = default;
    // Lets the recording go on, or holds it.
    virtual void play(bool goes_on) = 0;
    virtual Answer carryOut(const topics::ReplayOrder& order) = 0;
    // Fills in how the replay stands.
    virtual void describe(topics::Replay& replay) const = 0;
};

}  // namespace bonemill
