// Says whether a hand that holds nothing but the device lets the sampled loop come to rest: device,
// amplifier, delay, hold, relaxing spring and lagging tool as one linear difference equation per degree of
// freedom. Beyond the linear one, a spring that saturates and a wall that ends only take stiffness away.
//
// Translation and rotation are the same with other units: kg, N·s/m, N/m or kg·m², N·m·s/rad, N·m/rad.
// Everything is RT-safe and pure.
#pragma once

namespace bonemill {

// One degree of freedom of the device that the hand holds.
struct HandleAxis {
    double inertia = 0;      // of what moves with the handle
    double damping = 0;      // viscous
    double amplifier_s = 0;  // time constant of the amplifiers
    double delay_s = 0;      // from the reading of the encoders until the force that answers it begins
};

struct LoopSprings {
    double stiffness = 0;        // k
    double relaxing_share = 0;   // k_2 / k
    double relaxing_time = 0;    // τ_2, s
    double damping_time = 1e-3;  // τ, s: of the tool
};

// Returns by which factor per tick of dt the loop's slowest motion shrinks (below 1) or grows, with a wall of
// `wall` times k behind the tool; infinity stands for a wall that never gives way, 0 for free air.
double growthPerTick(const HandleAxis& axis, const LoopSprings& springs, double wall, double dt) noexcept;

}  // namespace bonemill
