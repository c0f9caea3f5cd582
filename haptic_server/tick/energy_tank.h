// Keeps account of the energy at the hand's port, in six degrees of freedom. What the simulated side stores
// in springs and contact and has given to the hand may grow by what the hand has put in, and by what the
// device's own damping takes away again. All beyond was made by sampling and delay; it empties a tank that
// what the coupling dissipates fills again.
//
// Work is that of the wrench that acted on the hand during the last period by the device's word, over the
// motion that was measured. Poses and wrenches are in V and the tool's: the wrench before it is scaled to the
// handle. It is RT-safe, for the tick thread.
#pragma once

#include <array>

#include "common/device_messages/device_messages.h"
#include "common/geometry/pose.h"
#include "haptic_server/tick/hand_limits.h"

namespace bonemill {

class EnergyTank {
  public:
    // J: some swings of a handle of 0.1 kg at 50 mm/s, and far less than what hurts.
    static constexpr double kRoom = 1e-3;

    explicit EnergyTank(double dt) noexcept : dt_(dt) {}
    // From now on this device is in the hand, and swings on springs of so much (N/m and N·m/rad, at the
    // hand). Its damping counts for what it takes beyond the share that a swing must lose by
    // LoopFit::kDampingRatio: else a swing that neither grows nor dies would leave the tank as it is.
    void setDevice(const HandleDynamics& handle, const HandSpring& spring, double workspace_scale) noexcept;
    // Begins anew with a full tank: what is stored has changed at one stroke.
    void fill() noexcept {
        content_ = kRoom;
        has_last_ = false;
        translation_work_ = rotation_work_ = 0;
    }

    // After the solve, with the pose that it was made for, the energy that springs and contact hold then and
    // the coupling's wrench on the hand.
    void add(const Pose& X_VT_device, double stored, const Wrench& wrench_hand_V) noexcept;

    double content() const noexcept { return content_; }
    bool isEmpty() const noexcept { return content_ <= 0; }
    // Tells through which of the two more energy has gone lately.
    bool turnsMoreThanMoves() const noexcept { return rotation_work_ > translation_work_; }

  private:
    static constexpr size_t kRings = 8;

    double dt_;
    size_t delay_ticks_ = 1;
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
