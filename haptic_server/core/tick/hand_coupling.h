// How stiffly the device in the hand is held, and the account of the energy that decides it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/device_messages/device_messages.h"
#include "common/geometry/hand_space.h"
#include "haptic_server/core/coupling/loop_fit.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/tick/hand_limits.h"
#include "haptic_server/core/tick/hand_side.h"
#include "haptic_server/core/tick/unrest_watch.h"

namespace bonemill {

// Keeps account of the energy at the hand's port, in six degrees of freedom. What the simulated side stores
// in springs and contact and has given to the hand may grow by what the hand and the effects have put in (a
// spindle drives a burr along the bone), and by what the device's own damping takes away again. All beyond
// was made by sampling and delay; it empties a tank that what the coupling dissipates fills again.
//
// Work is that of the wrench that acted on the hand during the last period by the device's word, over the
// motion that was measured. What the device cannot give, a torque perhaps, moves no hand and is late for no
// one: the work of the hand's turning is then that of the wrench as computed. Poses and wrenches are in V and
// the tool's: the wrench before it is scaled to the handle. It is RT-safe, for the tick thread.
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
                   const Felt& felt) noexcept {
        felt_ = felt;
        damping_ = space.forcePerWayAtTool(
            counted(handle.damping, handle.mass, space.forcePerWayAtHand(spring.stiffness)));
        angular_damping_ =
            space.torqueAtTool(counted(handle.angular_damping, handle.inertia, spring.rotation_stiffness));
        const double delay = handle.mass > 0 || handle.inertia > 0 ? handle.delay / dt_ : 1;
        delay_ticks_ = size_t(std::clamp(std::lround(delay), 0L, long(kRings - 2)));
        fill();
    }
    // Begins anew with a full tank: what is stored has changed at one stroke, or nobody kept the account.
    void fill() noexcept {
        content_ = kRoom;
        has_last_ = false;
        translation_work_ = rotation_work_ = 0;
    }

    void add(const PortStep& step) noexcept {
        if (has_last_) {
            const double made = step.stored - stored_last_ + workOnHand(step) - step.effects_work;
            content_ = std::min(content_ - made + kRoom * dt_ / kFillTime, kRoom);
        } else {
            sent_.fill(step.wrench_hand_V);  // as if it had been this all the time
        }
        X_VT_last_ = step.X_VT_device;
        stored_last_ = step.stored;
        newest_ = (newest_ + 1) % kRings;
        sent_[newest_] = step.wrench_hand_V;
        has_last_ = true;
    }

    double content() const noexcept { return content_; }
    bool isEmpty() const noexcept { return content_ <= 0; }
    // Tells through which of the two more energy has gone lately.
    bool turnsMoreThanMoves() const noexcept { return rotation_work_ > translation_work_; }

  private:
    static constexpr size_t kRings = 8;
    static constexpr double kFillTime = 10;   // s: a tank that is not used fills by itself
    static constexpr double kWorkTime = 0.1;  // s

    static double counted(double damping, double inertia, double stiffness) noexcept {
        return std::max(0.0, damping - LoopFit::kDampingRatio * std::sqrt(inertia * stiffness));
    }
    double workOnHand(const PortStep& step) noexcept {
        const Wrench& acted = sent_[(newest_ + kRings - delay_ticks_) % kRings];
        const Wrench& last = sent_[newest_];
        const Eigen::Vector3d way = step.X_VT_device.position - X_VT_last_.position;
        const Eigen::Vector3d turn = logRotation(step.X_VT_device.rotation * X_VT_last_.rotation.conjugate());
        const double translation =
            felt_.force ? acted.force.dot(way) : (last.force + step.wrench_hand_V.force).dot(way) / 2;
        const double rotation =
            felt_.torque ? acted.torque.dot(turn) : (last.torque + step.wrench_hand_V.torque).dot(turn) / 2;
        const double fading = std::max(0.0, 1 - dt_ / kWorkTime);
        translation_work_ = fading * translation_work_ + (felt_.force ? std::abs(translation) : 0);
        rotation_work_ = fading * rotation_work_ + (felt_.torque ? std::abs(rotation) : 0);
        const double taken = (damping_ * way.squaredNorm() + angular_damping_ * turn.squaredNorm()) / dt_;
        return translation + rotation - taken;
    }

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

// Decides how stiffly the gradient law's coupling holds the device that is in the hand.
//
// A hand damps what the device alone does not. So the coupling is as stiff as the scene and the device's own
// word allow until energy has been made at the hand's port (EnergyTank): then it gives way to what the
// device carries without a hand (hand_side.h), and by half and half again should that not be enough. It
// comes back when the tool has been in the air for a while, where no spring is stretched. What costs no
// stiffness of the wall is in force from the start: a larger share of the relaxing spring, a softer rotation.
//
// Without word of a device it is as the scene says, whatever happens. It is RT-safe, for the tick thread.
class HandCoupling {
  public:
    explicit HandCoupling(const TickConfig& config) noexcept
        : config_(config),
          side_(handSideOf(config)),
          wished_(side_.gradient),
          tank_(config.dt),
          watch_(config.dt) {}

    // All that the hand gets, as of now.
    const HandSide& side() const noexcept { return side_; }
    // Of the scene's stiffness so much is in force now, 1 for all.
    double share() const noexcept {
        return side_.gradient.translation_stiffness / config_.gradient.coupling.translation_stiffness;
    }
    double rotationShare() const noexcept {
        return side_.gradient.rotation_stiffness / config_.gradient.coupling.rotation_stiffness;
    }
    // The tool is pulled to there.
    Pose pulledFrom(const Pose& X_VT_device) const noexcept {
        return {X_VT_device.position + slack_, X_VT_device.rotation};
    }
    // With the last change, SpoCoupling::stretched.
    double stretched() const noexcept { return stretched_; }
    // False where only a hand can keep the device from swinging to and fro.
    bool standsAlone() const noexcept { return stands_alone_; }

    // Another device is there.
    void adaptTo(const DeviceCapabilities& device) noexcept;
    // `config` says something else than before, of the same device if there is one.
    void beginAnew() noexcept;
    // At the end of a tick of the gradient law, with its wrench before the effects' and the limits'. True:
    // the coupling is another from now on.
    bool takeAccount(const Pose& X_VT_device, const SpoStep& step, bool is_milling) noexcept;
    // Call it instead in a tick whose energies say nothing: another law, tool, bone, or no device.
    bool passOver() noexcept {
        tank_.fill();
        watch_.begin();
        stretched_ = 1;
        return goOnFitting();
    }

  private:
    bool goOnFitting() noexcept;
    void give(bool turns) noexcept;
    bool calm(const PortStep& port, bool is_touching, bool is_milling) noexcept;
    bool stiffen() noexcept;
    void soften(const Pose& X_VT_device, const Pose& X_VT) noexcept;
    void use() noexcept;

    const TickConfig& config_;
    HandSide side_;
    EnergyCouplingConfig wished_;  // before the fit
    EnergyCouplingConfig fitted_;
    DeviceFit fit_;
    bool stands_alone_ = true;
    bool has_device_ = false, is_fitted_ = true;
    DeviceCapabilities device_{};  // then: in the hand
    EnergyTank tank_;
    int given_ = 0, given_turns_ = 0;  // so many steps of translation and of rotation were given up
    UnrestWatch watch_;
    double rested_for_ = 0, comes_back_after_ = 0;  // s
    bool is_stiffening_ = false;
    double calmed_ = 1, calmed_turns_ = 1;             // of the stiffnesses, so that the hand is at rest
    Eigen::Vector3d slack_ = Eigen::Vector3d::Zero();  // m in V, between the hand and where it pulls from
    double stretched_ = 1;
    double in_air_for_ = 0;  // s
};

}  // namespace bonemill
