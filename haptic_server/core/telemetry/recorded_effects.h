// These are the parts of the effect record in which a scene's effects have something to say. What is not
// recorded is neither written, hashed, counted nor published.
#pragma once

#include <cstdint>

namespace bonemill {

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
