// What a viewer's mouse wants of the tool, checked: the payload of the topic HandPointer may be anything.
// Whose wish counts is decided here, too. Reading allocates and is not for the loop; thread-safe, never
// throws (other than std::bad_alloc).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/geometry/pose.h"

namespace bonemill {

struct HandWish {
    uint64_t sender = 0;
    uint64_t epoch = 0;  // the server's run that the viewer shows
    uint32_t sequence = 0;
    bool may_hold = false;  // its role lets it
    bool is_holding = false;
    Pose X_WT;             // of the tool point; meaningless unless is_holding
    uint32_t buttons = 0;  // Button bits
    // A number that is new says that the tool is put there, without a way there; 0 says nothing.
    uint32_t placements = 0;
};

// `sender` is that of the sample's envelope. Nothing comes of bytes that make no sense.
std::optional<HandWish> parseHandWish(std::span<const uint8_t> payload, uint64_t sender);

// Decides which viewer holds the tool: the first one that wants to, until it lets go or is silent. Times are
// CLOCK_MONOTONIC ns and come in as parameters. It is a plain value, for one thread.
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
