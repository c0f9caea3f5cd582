// Sleeps until one of several readers has samples. It is not for the tick.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/dds/participant.h"

namespace bonemill::dds {

class WaitSet {
  public:
    explicit WaitSet(const Participant& participant);

    // `handle` is asked before each wait, for a reader may begin anew; 0: there is none.
    void add(std::function<int32_t()> handle);
    // Returns true when a reader has samples to take, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout);

  private:
    struct Watched {
        std::function<int32_t()> handle;
        int32_t reader;
        Entity condition;
    };
    void watch(Watched& watched);

    Entity set_;
    std::vector<Watched> watched_;
};

}  // namespace bonemill::dds
