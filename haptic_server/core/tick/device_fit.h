// Fits the gradient law's coupling to the device that the hand holds, by what the device says of its mass,
// damping, delay and amplifiers (coupling/loop_fit.h). Without such word the coupling stays as it is.
//
// Stiffnesses in and out are those of the coupling, at the tool; the device is at the hand. It is RT-safe,
// for the tick thread; a whole fit beside the ticks is for any thread.
#pragma once

#include "haptic_server/core/coupling/loop_fit.h"
#include "haptic_server/core/tick/hand_side.h"

namespace bonemill {

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
