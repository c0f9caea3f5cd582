// Keeps account of the energy at the hand's port, in six degrees of freedom. What the simulated side stores
// in springs and contact and has given to the hand may grow by what the hand and the effects have put in (a
// spindle drives a burr along the bone), and by what the device's own damping takes away again. All beyond
// was made by sampling and delay; it empties a tank that what the coupling dissipates fills again.
//
// Work is that of the wrench that acted on the hand during the last period by the device's word, over the
// motion that was measured. What the device cannot give, a torque perhaps, moves no hand and is late for no
// one: the work of the hand's turning is then that of the wrench as computed. Poses and wrenches are in V and
// the tool's: the wrench before it is scaled to the handle. It is RT-safe, for the tick thread.
#pragma once

#include <array>

#include "common/device_messages/device_messages.h"
#include "common/geometry/hand_space.h"
#include "haptic_server/core/tick/hand_limits.h"

namespace bonemill {

// This is at the port after a tick's solve.
struct PortStep {
    Pose X_VT_device = {};      // for which it was made
    Wrench wrench_hand_V = {};  // of the coupling
    double stored = 0;          // J: springs and contact hold this now
    double effects_work = 0;    // J: that the effects' forces have done on the tool in this tick
};

class EnergyTank {
  public:
    // J: some swings of a handle of 0.1 kg at 50 mm/s, and far less than what hurts.
    static constexpr double kRoom = 1e-3;

    explicit EnergyTank(double dt) noexcept : dt_(dt) {}
    // From now on this device is in the hand, and swings on these springs. A wrench's part of which it gives
    // nothing is not `felt`. Its damping counts for what it takes beyond the share that a swing must lose by
    // LoopFit::kDampingRatio: else a swing that neither grows nor dies would leave the tank as it is.
    struct Felt {
        bool force = true, torque = true;
    };
    void setDevice(const HandleDynamics& handle, const HandSpring& spring, const HandSpace& space,
                   const Felt& felt) noexcept;
    // Begins anew with a full tank: what is stored has changed at one stroke, or nobody kept the account.
    void fill() noexcept {
        content_ = kRoom;
        has_last_ = false;
        translation_work_ = rotation_work_ = 0;
    }

    void add(const PortStep& step) noexcept;

    double content() const noexcept { return content_; }
    bool isEmpty() const noexcept { return content_ <= 0; }
    // Tells through which of the two more energy has gone lately.
    bool turnsMoreThanMoves() const noexcept { return rotation_work_ > translation_work_; }

  private:
    static constexpr size_t kRings = 8;
    double workOnHand(const PortStep& step) noexcept;

    double dt_;
    size_t delay_ticks_ = 1;
    Felt felt_;
    double damping_ = 0, angular_damping_ = 0;  // at the tool
    double content_ = kRoom;
    double translation_work_ = 0, rotation_work_ = 0;  // J, fading
    std::array<Wrench, kRings> sent_ = {};             // a ring
    size_t newest_ = 0;
    Pose X_VT_last_;
    double stored_last_ = 0;
    bool has_last_ = false;
};

}  // namespace bonemill
