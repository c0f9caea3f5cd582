// What ticks came to, as columns of one message. It is for normal threads.
#pragma once

#include "haptic_server/core/telemetry/tick_record.h"
#include "proto/journal.pb.h"

namespace bonemill {

class ResultColumns {
  public:
    void add(const TickRecord& record);
    bool isEmpty() const noexcept { return results_.count() == 0; }
    journal::Results take();

  private:
    journal::Results results_;
};

}  // namespace bonemill
