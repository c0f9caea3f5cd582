// Decides which viewer holds the tool: the first one that wants to, until it lets go or is silent.
//
// Times are CLOCK_MONOTONIC ns and come in as parameters. It is a plain value, for one thread.
#pragma once

#include <cstdint>
#include <optional>

#include "device_daemon/hands/pointer/hand_wish.h"

namespace bonemill {

class PointerHolder {
  public:
    static constexpr int64_t kSilenceNs = 1'000'000'000;

    // Returns true when the wish counts: it comes from who holds, and is newer than the one before. One that
    // lets go counts, too.
    bool take(const HandWish& wish, int64_t now_ns) noexcept;

    // Returns the sender that holds, if there is one.
    std::optional<uint64_t> holder(int64_t now_ns) const noexcept;

  private:
    uint64_t sender_ = 0;  // 0: none
    uint32_t sequence_ = 0;
    int64_t heard_ns_ = 0;
};

}  // namespace bonemill
