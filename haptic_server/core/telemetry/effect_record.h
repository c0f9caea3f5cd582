// This is what the effects of one tick tell the rest of the server, as a part of TickRecord. It is zero
// without an effect that says so; the burr's force and power are zero without one that reads contacts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace bonemill {

// These bits are what the trainee should know of a tick.
enum TickEvent : uint32_t {
    kEventNone = 0,
    kEventSpindleStalled = 1u << 0,
    kEventNearProtected = 1u << 1,     // nearer than the structure's warning distance
    kEventProtectedTouched = 1u << 2,  // contact with it
    kEventProtectedDamaged = 1u << 3,  // some of it was removed in this tick
    kEventTooHot = 1u << 4,            // bone above the temperature of necrosis
};

constexpr size_t kMaxOwnFigures = 8;

struct EffectRecord {
    uint32_t events;  // TickEvent bits
    // 1 + index of the scene's material that is nearest to the burr, is touched (hardest) and was damaged in
    // this tick; 0: none.
    uint32_t protected_id, touched_id, damaged_id;
    float spin_speed;       // rad/s about T's +y
    float burr_force;       // N: sum of the normal forces on the burr
    float axis_torque;      // N·m against the spin, on the tool
    float cutting_power;    // W: of all friction between burr and bone
    float removal_power;    // W: the part above the threshold pressure, which removes bone
    float removed_energy;   // J: specific energy of what was removed in this tick
    float temperature;      // °C: the hottest bone
    float necrotic_volume;  // m³ in all
    float
        protected_distance;  // m from the burr's surface, negative inside; without protected_id of no meaning
    float protected_force;   // N on the tool, from protected structures
    float damaged_volume;    // m³ of protected structures in all
    // Figures that no other code reads by name; effects/effect_figures.h says whose each is.
    float own[kMaxOwnFigures] = {};
};
static_assert(std::is_trivially_copyable_v<EffectRecord>);

// These are the parts of the effect record in which a scene's effects have something to say. What is not
// recorded is neither written, hashed, counted nor published.
struct RecordedEffects {
    bool burr = false;        // the burr's speed, force, torque and power
    bool heat = false;        // temperature and necrosis
    bool protection = false;  // what the tool does to protected structures
    uint32_t own = 0;         // bits: which of EffectRecord::own

    constexpr bool any() const noexcept { return burr || heat || protection || own != 0; }
    constexpr bool hasAnyOf(const RecordedEffects& other) const noexcept {
        return (burr && other.burr) || (heat && other.heat) || (protection && other.protection) ||
               (own & other.own) != 0;
    }
    constexpr void include(const RecordedEffects& other) noexcept {
        burr |= other.burr;
        heat |= other.heat;
        protection |= other.protection;
        own |= other.own;
    }
};

}  // namespace bonemill
