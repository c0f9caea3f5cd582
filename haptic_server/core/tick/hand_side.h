// This is what a tick does for the hand, by what the scene says and what the device can do: the limits of
// what it feels, and the couplings of both laws, which no device is to be held more stiffly by than it can
// bear.
//
// Couplings and poses are the tool's, limits and the spring's wrench the hand's
// (common/geometry/hand_space.h). It is RT-safe and pure.
#pragma once

#include <limits>

#include "common/device_messages/device_messages.h"
#include "haptic_server/core/coupling/loop_fit.h"
#include "haptic_server/core/tick/tick_config.h"

namespace bonemill {

// The couplings of `config` are as the hand is to feel them, and become those at the tool.
void setHandSpace(TickConfig& config, const HandSpace& space) noexcept;

struct HandSide {
    HandLimitsConfig limits;
    HandSpring spring;
    CouplingConfig thesis;
    EnergyCouplingConfig gradient;
    double most_pull = std::numeric_limits<double>::infinity();  // N: of the gradient law's coupling

    // The hand's spring follows.
    void setGradient(const EnergyCouplingConfig& coupling, const HandSpace& space) noexcept;
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

// Fits the gradient law's coupling to the device that the hand holds, by what the device says of its mass,
// damping, delay and amplifiers (coupling/loop_fit.h). Without such word the coupling stays as it is.
//
// Stiffnesses in and out are those of the coupling, at the tool; the device is at the hand. It is RT-safe,
// for the tick thread; a whole fit beside the ticks is for any thread.
class DeviceFit {
  public:
    DeviceFit() = default;
    DeviceFit(const TickConfig& config, const EnergyCouplingConfig& coupling,
              const DeviceCapabilities& device) noexcept;

    bool isDone() const noexcept { return translation_.isDone() && rotation_.isDone(); }
    // Goes on with a few eigenvalues.
    void advance() noexcept { translation_.isDone() ? rotation_.advance() : translation_.advance(); }
    void finish() noexcept {
        translation_.finish();
        rotation_.finish();
    }
    // Call it when it is done. Returns the coupling with which the device comes to rest by itself.
    EnergyCouplingConfig coupling() const noexcept;

  private:
    EnergyCouplingConfig coupling_;
    HandSpace space_;
    LoopFit translation_, rotation_;
};

// Returns what the hand gets in the end, when the fit is done: for start-up and reports.
HandSide fittedHandSide(const TickConfig& config, const DeviceCapabilities& device) noexcept;

}  // namespace bonemill
