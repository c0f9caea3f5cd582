// Makes digests of what the ticks of a session decided, one for each part of it, so that a replay that
// differs says where. What the clock measured and what hangs on it is not in them. It is for normal threads.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "haptic_server/recording/statistics/state_hash.h"

namespace bonemill {

class TickHash {
  public:
    static constexpr size_t kParts = 6;
    // Names of the parts, for people.
    static constexpr std::array<std::string_view, kParts> kNames = {
        "the hand's pose", "the tool's pose", "the force on the hand", "contact", "removal", "effects"};

    explicit TickHash(const RecordedEffects& recorded = {}) : recorded_(recorded) {}

    void add(const TickRecord& record) noexcept;
    // So far, in the order of kNames.
    std::array<uint64_t, kParts> parts() const noexcept;
    // Of all parts so far: two that have once differed agree in 1 of 65,536 ticks.
    uint16_t check() const noexcept;

  private:
    RecordedEffects recorded_;
    std::array<StateHash, kParts> parts_;
};

}  // namespace bonemill
