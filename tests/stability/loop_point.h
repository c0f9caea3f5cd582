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
    double late_ticks = 0;  // beside whole ticks, below 1
    double jitter_ticks = 0;
    double lost_share = 0;
    double encoder_step = 5e-6;  // m
    double most_force = 0;       // N; 0: all
    double push = 2;             // N, of the hand's springs or, without a hand, a weight
    double amplifier_hz = 1000;
    bool has_torque = true;
    uint32_t seed = 1;  // of what it says wrongly

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
    double share = 0;                      // of the scene's stiffness
    bool is_lost = false;                  // off the bone, or the handle flew away, or not finite
    bool isQuiet() const noexcept { return !is_lost && force_rms <= kFeltForce && torque_rms <= kFeltTorque; }
};

// What the device tells of itself.
enum class Says {
    kNobody,  // no device has spoken
    kLittle,  // only what it gives
    kTruth,
    kWrong,  // every figure is wrong by kWrongBy
};
inline constexpr double kWrongBy = 0.3;
const char* nameOf(Says says);

// Lets the loop swing for as long as its swing becomes smaller or its coupling another, 7 s at most.
LoopVerdict tryLoop(const LoopPoint& point, const Variant& variant, Says says);

// The n-th of the random devices: as light and as heavy, as slow, as smooth and as rough as arms are, held or
// let go, with and without dry friction.
LoopPoint randomDevice(int n);
inline constexpr int kRandomDevices = 200;

}  // namespace bonemill::test
