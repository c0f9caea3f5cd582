// This is the emulated motion controller with the ARES and the hand behind it, without a socket and without a
// thread: commands come in through its session, states come out of period().
//
// Times are CLOCK_MONOTONIC ns; units and frames are those of ares_emulator.h. It is RT-safe after
// construction, for one thread.
#pragma once

#include <cstdint>
#include <vector>

#include "device_daemon/ares/driver/ares_emulator.h"
#include "device_daemon/ares/emulator/fault_spec.h"
#include "device_daemon/ares/emulator/scenario.h"
#include "device_daemon/ares/wire/controller_session.h"
#include "device_daemon/ares/wire/drive_state.h"

namespace bonemill {

// This is what the simulated hand does beside moving the handle: it holds the enabling switch and presses the
// button to reset, as a person would who wants to go on.
class HandScript {
  public:
    struct View {
        wire::DriveState drive = wire::DriveState::kNotReady;
        bool is_engaged = false;  // the hand feels haptic_server
    };

    // Once per period.
    void update(const View& view, int64_t now_ns) noexcept;

    bool holdsEnablingSwitch() const noexcept { return holds_switch_; }
    bool pressesReset() const noexcept { return presses_reset_; }

  private:
    void pressSwitchAnew(const View& view, int64_t now_ns) noexcept;
    void pressResetInTrouble(const View& view, int64_t now_ns) noexcept;

    bool has_begun_ = false;
    bool has_pressed_ = false;
    bool holds_switch_ = false;
    bool presses_reset_ = false;
    bool was_faulty_ = false;
    int64_t switch_pressed_ns_ = 0;  // the last time that it was let go in order to press it
    int64_t quiet_since_ns_ = 0;     // from here on nothing has worked
};

struct EmulatedControllerConfig {
    double rate_hz = 1000;
    uint32_t watchdog_us = wire::kDefaultWatchdogUs;
    bool is_homed = true;  // at the start
    std::vector<FaultSpec> faults;
};

class EmulatedController {
  public:
    EmulatedController(const Scenario& scenario, const EmulatedControllerConfig& config, int64_t now_ns);

    wire::ControllerSession<wire::JointPackets>& session() noexcept { return session_; }
    const wire::ControllerSession<wire::JointPackets>& session() const noexcept { return session_; }

    // Lets the world live until now under the forces that hold, then takes those of the newest command.
    void obey(int64_t now_ns) noexcept;
    // One period: the world lives until now, and the state to be sent, but for its seal, is filled in.
    void period(int64_t now_ns, wire::JointState& state) noexcept;

    // The hand does its script anew, once it has drawn back to where that starts.
    void beginAnew() noexcept;
    // The hand draws back to where its script starts, and rests there until beginAnew().
    void rest() noexcept { is_resting_ = true; }

    // From now on the states say that the controller ends in order, and the scenario rests.
    void leave() noexcept { is_leaving_ = true; }

    // The host says that the hand feels haptic_server.
    bool isEngaged(int64_t now_ns) const noexcept;
    bool wasEngaged() const noexcept { return was_engaged_; }
    // Since the hand was engaged first, s; negative before.
    double engagedSeconds(int64_t now_ns) const noexcept;
    const EmulatorState& plant() const noexcept { return plant_.state(); }

  private:
    bool has(FaultKind kind, int64_t now_ns) const noexcept;
    uint32_t deviceFaults(int64_t now_ns) const noexcept;
    void home(int64_t now_ns) noexcept;
    uint32_t inputs(int64_t now_ns) const noexcept;
    void readEncoders(int64_t now_ns, wire::JointState& state) noexcept;
    void tellAxes(int64_t now_ns, wire::JointState& state) const noexcept;

    AresEmulator plant_;
    double encoder_step_;
    std::vector<FaultSpec> faults_;
    wire::ControllerSession<wire::JointPackets> session_;
    HandScript hand_;
    int64_t lived_until_ns_;
    Vector6d forces_ = Vector6d::Zero();  // N, that the amplifiers are told
    Vector6d power_on_q_ = Vector6d::Zero();
    Vector6d told_q_ = Vector6d::Zero();  // what the last state said
    bool is_homed_;
    bool is_homing_ = false;
    int64_t homing_since_ns_ = 0;
    bool is_leaving_ = false;
    bool is_resting_ = false;
    bool was_engaged_ = false;
    int64_t first_engaged_ns_ = 0;
};

}  // namespace bonemill
