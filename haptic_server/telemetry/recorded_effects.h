// These are the parts of the effect record in which a scene's effects have something to say. What is not
// recorded is neither written, hashed, counted nor published.
#pragma once

namespace bonemill {

struct RecordedEffects {
    bool burr = false;        // speed, force, torque, power: energy_removal, cutting_force, spindle,
                              // burr_vibration, thermal
    bool heat = false;        // thermal
    bool protection = false;  // protected_structures

    bool any() const noexcept { return burr || heat || protection; }
};

}  // namespace bonemill
