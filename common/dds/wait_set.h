// Sleeps until one of several readers has samples. It is not for the tick.
#pragma once

#include <chrono>
#include <vector>

#include "common/dds/participant.h"

namespace bonemill::dds {

class WaitSet {
  public:
    explicit WaitSet(const Participant& participant);

    void add(int32_t reader);
    // Returns true when a reader has samples to take, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout) const;

  private:
    Entity set_;
    std::vector<Entity> conditions_;
};

}  // namespace bonemill::dds
