// Sums up the events of several ticks, and which protected structure the worst of them was about. It is
// a plain value.
#pragma once

#include "haptic_server/core/telemetry/effect_record.h"

namespace bonemill {

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

}  // namespace bonemill
