#include "haptic_server/recording/rerun/replay_events.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/commands/command_text.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/statistics/device_history.h"

namespace bonemill {
namespace {

constexpr double kPauseS = 0.5;
constexpr size_t kMaxText = 2000;  // of one tick

std::string textOf(const journal::Event& event) {
    switch (event.what_case()) {
        case journal::Event::kAttemptBegan:
            return "attempt of " + printableLine(event.attempt_began()) + " begins";
        case journal::Event::kAttemptEnded:
            return "attempt of " + printableLine(event.attempt_ended().trainee()) + " ends";
        case journal::Event::kAttemptDropped:
            return "the attempt was begun by mistake: it counts as none";
        case journal::Event::kIncomplete:
            return "the recording lacks something from here on: " + printableLine(event.incomplete().why());
        case journal::Event::kEnd:
            return "the session ends";
        default:
            return "";
    }
}

std::string textOf(const journal::Order& order) {
    const std::string who =
        order.command().name().empty() ? "order" : "order of " + printableLine(order.command().name());
    return who + ": " + orderText(order.command()) + ": " + printableLine(order.result());
}

}  // namespace

ReplayEvents::ReplayEvents(const Recording& recording)
    : structures_(recording.manifest().material_names().begin(), recording.manifest().material_names().end()),
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

void ReplayEvents::add(uint64_t tick, const std::string& text) {
    const std::lock_guard lock(mutex_);
    std::string& there = events_[tick];
    if (there.size() + text.size() > kMaxText) return;
    there += (there.empty() ? "" : "; ") + text;
}

void ReplayEvents::addEffects(uint64_t tick, const EffectRecord& effects) {
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

std::optional<ReplayEvent> ReplayEvents::at(uint64_t tick) const {
    const std::lock_guard lock(mutex_);
    const auto found = events_.find(tick);
    if (found == events_.end()) return std::nullopt;
    return ReplayEvent{found->first, found->second};
}

std::optional<ReplayEvent> ReplayEvents::after(uint64_t tick) const {
    const std::lock_guard lock(mutex_);
    const auto found = events_.upper_bound(tick);
    if (found == events_.end()) return std::nullopt;
    return ReplayEvent{found->first, found->second};
}

std::optional<ReplayEvent> ReplayEvents::before(uint64_t tick) const {
    const std::lock_guard lock(mutex_);
    const auto found = events_.lower_bound(tick);
    if (found == events_.begin()) return std::nullopt;
    return ReplayEvent{std::prev(found)->first, std::prev(found)->second};
}

size_t ReplayEvents::count() const {
    const std::lock_guard lock(mutex_);
    return events_.size();
}

}  // namespace bonemill
