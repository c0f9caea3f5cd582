// Decides how stiffly the gradient law's coupling holds the device that is in the hand.
//
// A hand damps what the device alone does not. So the coupling is as stiff as the scene and the device's own
// word allow until energy has been made at the hand's port (energy_tank.h): then it gives way to what the
// device carries without a hand (hand_side.h), and by half and half again should that not be enough. It
// comes back when the tool has been in the air for a while, where no spring is stretched. What costs no
// stiffness of the wall is in force from the start: a larger share of the relaxing spring, a softer rotation.
//
// Without word of a device it is as the scene says, whatever happens. It is RT-safe, for the tick thread.
#pragma once

#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/tick/energy_tank.h"
#include "haptic_server/core/tick/hand_side.h"

namespace bonemill {

class HandCoupling {
  public:
    explicit HandCoupling(const TickConfig& config) noexcept
        : config_(config), side_(handSideOf(config)), wished_(side_.gradient), tank_(config.dt) {}

    // All that the hand gets, as of now.
    const HandSide& side() const noexcept { return side_; }
    // Of the scene's stiffness so much is in force now, 1 for all.
    double share() const noexcept {
        return side_.gradient.translation_stiffness / config_.gradient.coupling.translation_stiffness;
    }
    double rotationShare() const noexcept {
        return side_.gradient.rotation_stiffness / config_.gradient.coupling.rotation_stiffness;
    }
    // False where only a hand can keep the device from swinging to and fro.
    bool standsAlone() const noexcept { return stands_alone_; }

    // Another device is there.
    void adaptTo(const DeviceCapabilities& device) noexcept;
    // At the end of a tick of the gradient law, with its wrench before the effects' and the limits'. True:
    // the coupling is another from now on.
    bool takeAccount(const Pose& X_VT_device, const SpoStep& step) noexcept;
    // Call it instead in a tick whose energies say nothing: another law, tool, bone, or no device.
    bool passOver() noexcept {
        tank_.fill();
        return goOnFitting();
    }

  private:
    bool goOnFitting() noexcept;
    void give(bool turns) noexcept;
    void use() noexcept;

    const TickConfig& config_;
    HandSide side_;
    EnergyCouplingConfig wished_;  // before the fit
    EnergyCouplingConfig fitted_;
    DeviceFit fit_;
    bool stands_alone_ = true;
    bool has_device_ = false, is_fitted_ = true;
    EnergyTank tank_;
    int given_ = 0, given_turns_ = 0;  // so many steps of translation and of rotation were given up
    double in_air_for_ = 0;            // s
};

}  // namespace bonemill
