// One point of the large grid of the closed loop: a device, its way to the server and a hand, pressed on a
// plane or in a hole, and what becomes of it.
#pragma once

#include <string>
#include <vector>

#include "tests/stability/drive.h"

namespace bonemill::test {

// No motion may go on that is felt more than this, N and N·m RMS.
inline constexpr double kFeltForce = 5e-3, kFeltTorque = 0.05e-3;

enum class LoopPlace { kPlane, kHole };

struct LoopPoint {
    LoopPlace place = LoopPlace::kPlane;
    int hand = 0;          // of loopHands()
    double friction = 0;   // N, dry
    double mass = 0.1;     // kg
    double damping = 0.5;  // N·s/m
    int delay_ticks = 1;
    double jitter_ticks = 0;
    double lost_share = 0;
    double encoder_step = 5e-6;  // m
    double most_force = 0;       // N; 0: all

    // Rotation goes with translation: 14 mm of gyration, the other figures on levers of the same kind.
    LoopConfig config() const;
};

struct NamedHand {
    const char* name;
    HandPlant plant;
};
const std::vector<NamedHand>& loopHands();  // from none to stiff
const char* nameOf(LoopPlace place);

struct LoopVerdict {
    double force_rms = 0, torque_rms = 0;  // of the last half second, N and N·m
    double wall = 0;                       // N/m: coupling's stiffness at the end
    bool is_lost = false;                  // off the bone, or the handle flew away, or not finite
    bool isQuiet() const noexcept { return !is_lost && force_rms <= kFeltForce && torque_rms <= kFeltTorque; }
};

// Lets the loop swing for as long as its swing becomes smaller, 4 s at most. With `declares` the device says
// what it is like.
LoopVerdict tryLoop(const LoopPoint& point, const Variant& variant, bool declares);

}  // namespace bonemill::test
