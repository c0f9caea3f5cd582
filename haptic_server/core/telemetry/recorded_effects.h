// These are the parts of the effect record in which a scene's effects have something to say. What is not
// recorded is neither written, hashed, counted nor published.
#pragma once

namespace bonemill {

struct RecordedEffects {
    bool burr = false;        // the burr's speed, force, torque and power
    bool heat = false;        // temperature and necrosis
    bool protection = false;  // what the tool does to protected structures

    bool any() const noexcept { return burr || heat || protection; }
    void include(const RecordedEffects& other) noexcept {
        burr |= other.burr;
        heat |= other.heat;
        protection |= other.protection;
    }
};

}  // namespace bonemill
