// What happened in a recording, in words, by the tick at which it did. Any normal thread; it takes a mutex.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/commands/command_text.h"
#include "common/text/foreign_text.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/statistics/run_statistics.h"

namespace bonemill {

struct ReplayEvent {
    uint64_t tick;
    std::string text;
};

class ReplayEvents {
  public:
    // With what the journal tells: attempts, orders and their answers, stops of the device.
    explicit ReplayEvents(const Recording& recording)
        : structures_(recording.manifest().material_names().begin(),
                      recording.manifest().material_names().end()),
          pause_ticks_(uint64_t(std::llround(kPauseS * recording.manifest().rate_hz()))) {
        const uint64_t last = recording.ticks() - 1;
        const auto keep = [&](uint64_t tick, const std::string& text) {
            if (!text.empty()) add(std::min(tick, last), text);
        };
        for (const journal::Event& event : recording.content().events) keep(event.tick(), textOf(event));
        for (const journal::Order& order : recording.content().orders) keep(order.tick(), textOf(order));
        for (const auto& [tick, device] : recording.deviceChanges())
            keep(tick, "the device: " + deviceText(device));
    }

    void add(uint64_t tick, const std::string& text) {
        const std::lock_guard lock(mutex_);
        std::string& there = events_[tick];
        if (there.size() + text.size() > kMaxText) return;
        there += (there.empty() ? "" : "; ") + text;
    }
    // Adds what the tick's effects tell that those of the half second before did not. Ticks come one after
    // the other.
    void addEffects(uint64_t tick, const EffectRecord& effects) {
        const auto begins = [&](uint32_t bit) {
            if (!(effects.events & bit)) return false;
            const uint64_t seen = std::exchange(seen_[bit], tick + 1);
            return seen == 0 || tick + 1 - seen > pause_ticks_;
        };
        const auto nameOf = [&](uint32_t structure) {
            const bool is_known = structure > 0 && structure <= structures_.size();
            return is_known ? structures_[structure - 1] : std::string("a structure");
        };
        if (begins(kEventSpindleStalled)) add(tick, "the burr stalls");
        if (begins(kEventTooHot)) add(tick, "bone gets too hot");
        if (begins(kEventProtectedTouched)) add(tick, nameOf(effects.touched_id) + " is touched");
        if (begins(kEventProtectedDamaged)) add(tick, nameOf(effects.damaged_id) + " is damaged");
    }

    std::optional<ReplayEvent> at(uint64_t tick) const {
        const std::lock_guard lock(mutex_);
        const auto found = events_.find(tick);
        if (found == events_.end()) return std::nullopt;
        return ReplayEvent{found->first, found->second};
    }
    std::optional<ReplayEvent> after(uint64_t tick) const {
        const std::lock_guard lock(mutex_);
        const auto found = events_.upper_bound(tick);
        if (found == events_.end()) return std::nullopt;
        return ReplayEvent{found->first, found->second};
    }
    std::optional<ReplayEvent> before(uint64_t tick) const {
        const std::lock_guard lock(mutex_);
        const auto found = events_.lower_bound(tick);
        if (found == events_.begin()) return std::nullopt;
        return ReplayEvent{std::prev(found)->first, std::prev(found)->second};
    }
    size_t count() const {
        const std::lock_guard lock(mutex_);
        return events_.size();
    }

  private:
    static constexpr double kPauseS = 0.5;
    static constexpr size_t kMaxText = 2000;  // of one tick
    static std::string textOf(const journal::Event& event) {
        switch (event.what_case()) {
            case journal::Event::kAttemptBegan:
                return "attempt of " + printableLine(event.attempt_began()) + " begins";
            case journal::Event::kAttemptEnded:
                return "attempt of " + printableLine(event.attempt_ended().trainee()) + " ends";
            case journal::Event::kAttemptDropped:
                return "the attempt was begun by mistake: it counts as none";
            case journal::Event::kIncomplete:
                return "the recording lacks something from here on: " +
                       printableLine(event.incomplete().why());
            case journal::Event::kEnd:
                return "the session ends";
            default:
                return "";
        }
    }
    static std::string textOf(const journal::Order& order) {
        const std::string who =
            order.command().name().empty() ? "order" : "order of " + printableLine(order.command().name());
        return who + ": " + orderText(order.command()) + ": " + printableLine(order.result());
    }

    mutable std::mutex mutex_;
    std::map<uint64_t, std::string> events_;
    const std::vector<std::string> structures_;  // the scene's materials
    const uint64_t pause_ticks_;                 // what comes again within N ticks is the same event
    std::map<uint32_t, uint64_t> seen_;          // of each bit: 1 + the tick that had it last
};

}  // namespace bonemill
