// Lets an effect add to the energy that the simulated tool's pose minimises.
#pragma once

#include "haptic_server/coupling/energy_coupling.h"

namespace bonemill {

class SolveEnergy {
  public:
    virtual ~SolveEnergy() = default;
    // At this pose of the tool. Within a tick one fixed function, bounded from below; its stiffness positive
    // semi-definite. RT-safe; tick thread only.
    virtual EnergyTerm at(const Pose& X_VT) const noexcept = 0;
};

}  // namespace bonemill
