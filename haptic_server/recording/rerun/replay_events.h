// What happened in a recording, in words, by the tick at which it did. Any normal thread; it takes a mutex.
#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

class Recording;

struct ReplayEvent {
    uint64_t tick;
    std::string text;
};

class ReplayEvents {
  public:
    // With what the journal tells: attempts, orders and their answers, stops of the device.
    explicit ReplayEvents(const Recording& recording);

    void add(uint64_t tick, const std::string& text);
    // Adds what the tick's effects tell that those of the half second before did not. Ticks come one after
    // the other.
    void addEffects(uint64_t tick, const EffectRecord& effects);

    std::optional<ReplayEvent> at(uint64_t tick) const;
    std::optional<ReplayEvent> after(uint64_t tick) const;
    std::optional<ReplayEvent> before(uint64_t tick) const;
    size_t count() const;

  private:
    mutable std::mutex mutex_;
    std::map<uint64_t, std::string> events_;
    const std::vector<std::string> structures_;  // the scene's materials
    const uint64_t pause_ticks_;                 // what comes again within N ticks is the same event
    std::map<uint32_t, uint64_t> seen_;          // of each bit: 1 + the tick that had it last
};

}  // namespace bonemill
