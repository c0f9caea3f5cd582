// This is what a tick does for the hand, by what the scene says and what the device can do: the limits of
// what it feels, and the couplings of both laws, which no device is to be held more stiffly by than it can
// bear.
//
// Couplings and poses are the tool's, limits and the spring's wrench the hand's. The tool moves
// workspace_scale times as far as the handle and turns with it. Seen from the hand the tool's world is
// smaller by that factor: the force is the same, the torque is divided by it, and so is the power, in
// translation and rotation alike. Were the torque not divided, a closed path of the hand could gain energy.
// It is RT-safe and pure.
#pragma once

#include <limits>

#include "common/device_messages/device_messages.h"
#include "haptic_server/core/tick/tick_config.h"

namespace bonemill {

// Turns couplings as the hand is to feel them into those at the tool: where it goes `scale` times as far, a
// spring of the same force is softer, and one of `scale` times the torque stiffer.
void scaleWorkspace(TickConfig& config, double scale) noexcept;

struct HandSide {
    HandLimitsConfig limits;
    HandSpring spring;
    CouplingConfig thesis;
    EnergyCouplingConfig gradient;
    double most_pull = std::numeric_limits<double>::infinity();  // N: of the gradient law's coupling

    // The hand's spring follows.
    void setGradient(const EnergyCouplingConfig& coupling, double workspace_scale) noexcept;
};

// Before a device has said what it can do, everything is as the scene says.
HandSide handSideOf(const TickConfig& config) noexcept;

// The device lowers what the scene says, and never raises it:
// - the norms of force and torque; without an ability they are 0;
// - the pull of the gradient law's coupling, so that the simulated tool is pulled with what the hand feels;
// - the stiffness, to what the device holds in the hand without shaking. In the gradient law the relaxing
//   spring's share is part of it, for between two ticks both springs push back. It is not lowered below what
//   a scene may say, nor for the lever of a grip beside the tool point.
// Without force or torque there is nothing to adapt a coupling to: the tool then follows the hand as in the
// scene. `device` is plausible.
HandSide handSideOf(const TickConfig& config, const DeviceCapabilities& device) noexcept;

}  // namespace bonemill
