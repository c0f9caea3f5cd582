// Lets an effect add to the energy that the simulated tool's pose minimises.
#pragma once

#include "haptic_server/core/coupling/energy_coupling.h"

namespace bonemill {

class SolveEnergy {
  public:
    virtual ~SolveEnergy() = default;
    // Returns the energy at this pose of the tool. Within a tick it is one fixed function, bounded from
    // below, with a positive semi-definite stiffness. It is RT-safe, for the tick thread only.
    virtual EnergyTerm at(const Pose& X_VT) const noexcept = 0;
};

}  // namespace bonemill
