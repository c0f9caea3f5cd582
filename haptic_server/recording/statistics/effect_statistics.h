// Keeps what the effects of a run told, from its tick records: extremes, totals, and what the trainee
// was warned of.
//
// One normal thread calls it; add() allocates nothing. Units are those of the figures' keys.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/core/telemetry/effect_record.h"

namespace bonemill {

// Sums up the events of several ticks, and which protected structure the worst of them was about. It is
// a plain value.
struct EventSum {
    uint32_t events = kEventNone;  // TickEvent bits
    uint32_t structure = 0;        // 1 + index of the scene's material; 0: none

    void add(const EffectRecord& record) noexcept {
        const uint32_t worst_before = worstOf(events);
        events |= record.events;
        const uint32_t worst = worstOf(record.events);
        if (worst != 0 && worst >= worst_before) structure = structureOf(record, worst);
    }
    void add(const EventSum& later) noexcept {
        if (worstOf(later.events) != 0 && worstOf(later.events) >= worstOf(events))
            structure = later.structure;
        events |= later.events;
    }

  private:
    static uint32_t worstOf(uint32_t events) noexcept {
        for (const uint32_t event : {kEventProtectedDamaged, kEventProtectedTouched, kEventNearProtected})
            if (events & event) return event;
        return 0;
    }
    static uint32_t structureOf(const EffectRecord& record, uint32_t event) noexcept {
        if (event == kEventProtectedDamaged) return record.damaged_id;
        return event == kEventProtectedTouched ? record.touched_id : record.protected_id;
    }
};
static_assert(kEventProtectedDamaged > kEventProtectedTouched &&
              kEventProtectedTouched > kEventNearProtected);

class EffectStatistics {
  public:
    struct Figure {
        const EffectFigure* is;
        double value;
    };

    explicit EffectStatistics(const RecordedEffects& recorded = {}) : recorded_(recorded) {
        for (size_t n = 0; n < figures_.size(); ++n) figures_[n] = startOf(kEffectFigures[n].run.summary);
    }

    void add(const EffectRecord& record) noexcept {
        const std::optional<double> nearest_before = figure("protected_distance_min_mm");
        for (size_t n = 0; n < figures_.size(); ++n) {
            const EffectFigure& figure = kEffectFigures[n];
            if (!figure.run.key || !figure.isToldBy(recorded_)) continue;
            const double value = figure.numberIn(record);
            if (std::isfinite(value)) figures_[n] = summedUp(figure.run.summary, figures_[n], value);
        }
        if (figure("protected_distance_min_mm") != nearest_before) nearest_id_ = record.protected_id;
        events_ |= record.events;
        book(kEventNearProtected, record.protected_id, record);
        book(kEventProtectedTouched, record.touched_id, record);
        book(kEventProtectedDamaged, record.damaged_id, record);
    }

    const RecordedEffects& recorded() const noexcept { return recorded_; }
    // What is recorded and has a value yet: effects' figures in the order of effects/effect_figures.h.
    std::vector<Figure> figures() const {
        std::vector<Figure> figures;
        for (size_t n = 0; n < figures_.size(); ++n)
            if (kEffectFigures[n].run.key && figures_[n] && kEffectFigures[n].isToldBy(recorded_))
                figures.push_back({&kEffectFigures[n], *figures_[n]});
        return figures;
    }
    // The one with this key; nothing while it has no value.
    std::optional<double> figure(std::string_view key) const noexcept {
        for (size_t n = 0; n < figures_.size(); ++n)
            if (kEffectFigures[n].run.key && kEffectFigures[n].run.key == key) return figures_[n];
        return std::nullopt;
    }
    // The name of the structure that the least distance is of; empty while there is none.
    std::string nearest(const std::vector<std::string>& materials) const {
        return nearest_id_ == 0 ? "" : nameOf(nearest_id_, materials);
    }
    // Each warning comes once, in words; `materials` are the materials' names in the scene's order.
    std::vector<std::string> warnings(const std::vector<std::string>& materials) const {
        constexpr std::pair<TickEvent, const char*> kWorstFirst[] = {{kEventProtectedDamaged, "damaged "},
                                                                     {kEventProtectedTouched, "touched "},
                                                                     {kEventNearProtected, "came near "}};
        std::vector<std::string> warnings;
        for (const auto& [event, what] : kWorstFirst)
            for (size_t id = 0; id < events_of_.size(); ++id)
                if (events_of_[id] & event) warnings.push_back(what + nameOf(id, materials));
        if (events_ & kEventTooHot) warnings.emplace_back("bone too hot");
        if (events_ & kEventSpindleStalled) warnings.emplace_back("spindle stalled");
        return warnings;
    }
    // The protected structures that the burr touched, by name.
    std::vector<std::string> touched(const std::vector<std::string>& materials) const {
        std::vector<std::string> names;
        for (size_t id = 0; id < events_of_.size(); ++id)
            if (events_of_[id] & (kEventProtectedTouched | kEventProtectedDamaged))
                names.push_back(nameOf(id, materials));
        return names;
    }

  private:
    // What a run's figure is before its first tick.
    static std::optional<double> startOf(RunSummary summary) noexcept {
        if (summary == RunSummary::kLargest || summary == RunSummary::kMin) return std::nullopt;
        return 0;
    }
    static double summedUp(RunSummary summary, std::optional<double> before, double value) noexcept {
        switch (summary) {
            case RunSummary::kLargest:
                return std::max(before.value_or(value), value);
            case RunSummary::kLargestSize:
                return std::max(before.value_or(0), std::abs(value));
            case RunSummary::kMin:
                return std::min(before.value_or(value), value);
            case RunSummary::kSum:
                return before.value_or(0) + value;
            case RunSummary::kLast:
            case RunSummary::kNone:
                return value;
        }
        return value;
    }
    static std::string nameOf(size_t id, const std::vector<std::string>& materials) {
        if (id == 0 || id > materials.size()) return "a protected structure";
        const std::string& name = materials[id - 1];
        return name.empty() ? "material " + std::to_string(id) : name;
    }

    void book(uint32_t event, size_t structure, const EffectRecord& record) noexcept {
        events_of_[std::min(structure, events_of_.size() - 1)] |= record.events & event;
    }

    RecordedEffects recorded_;
    std::array<std::optional<double>, kEffectFigures.size()> figures_;
    uint32_t nearest_id_ = 0;                   // of the least distance to a protected structure
    uint32_t events_ = 0;                       // that were ever set
    std::array<uint32_t, 256> events_of_ = {};  // by material
};

}  // namespace bonemill
