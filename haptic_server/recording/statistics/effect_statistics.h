// Keeps what the effects of a run told, from its tick records: extremes, totals, and what the trainee
// was warned of.
//
// One normal thread calls it; add() allocates nothing. Units are those of the figures' keys.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/telemetry/recorded_effects.h"

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

    explicit EffectStatistics(const RecordedEffects& recorded = {});

    void add(const EffectRecord& record) noexcept;

    const RecordedEffects& recorded() const noexcept { return recorded_; }
    // What is recorded and has a value yet: effects' figures in the order of effects/effect_figures.h.
    std::vector<Figure> figures() const;
    // The one with this key; nothing while it has no value.
    std::optional<double> figure(std::string_view key) const noexcept;
    // The name of the structure that the least distance is of; empty while there is none.
    std::string nearest(const std::vector<std::string>& materials) const;
    // Each warning comes once, in words; `materials` are the materials' names in the scene's order.
    std::vector<std::string> warnings(const std::vector<std::string>& materials) const;
    // The protected structures that the burr touched, by name.
    std::vector<std::string> touched(const std::vector<std::string>& materials) const;

  private:
    void book(uint32_t event, size_t structure, const EffectRecord& record) noexcept;

    RecordedEffects recorded_;
    std::array<std::optional<double>, kEffectFigures.size()> figures_;
    uint32_t nearest_id_ = 0;                   // of the least distance to a protected structure
    uint32_t events_ = 0;                       // that were ever set
    std::array<uint32_t, 256> events_of_ = {};  // by material
};

}  // namespace bonemill
