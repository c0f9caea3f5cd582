// Compares an EnergyTerm's wrench with central differences of its energy.
#pragma once

#include <gtest/gtest.h>

#include "haptic_server/core/coupling/energy_coupling.h"

namespace bonemill::test {

// Calls `energy(pose)`; `step` is in m and, divided by `lever`, in rad.
template <class Energy>
void expectWrenchIsGradient(const Energy& energy, const Pose& pose, double step, double lever, double slack) {
    const EnergyTerm at = energy(pose);
    for (int n = 0; n < 6; ++n) {
        Vector6d way = Vector6d::Zero();
        way[n] = n < 3 ? step : step / lever;
        const auto moved = [&](double share) {
            return energy(pose.incremented(share * way.head<3>(), share * way.tail<3>())).energy;
        };
        const double slope = (moved(-1) - moved(1)) / (2 * way[n]);
        EXPECT_NEAR(n < 3 ? at.wrench.force[n] : at.wrench.torque[n - 3], slope,
                    n < 3 ? slack : slack * lever)
            << "component " << n;
    }
}

}  // namespace bonemill::test
