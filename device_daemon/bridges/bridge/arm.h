// A bridge knows its haptic arm as this: something that is opened, that says in each of its periods where the
// handle is, and that takes a wrench in answer.
//
// D and T are the arm's base and its handle as docs/howto/bridges.md lays them: x to the operator's left, y
// towards the operator, z up, origin in the middle of the workspace. Units are m, N, N·m, rad, s; stamps are
// CLOCK_MONOTONIC ns.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/device_messages/device_messages.h"
#include "common/geometry/pose.h"

namespace bonemill::bridge {

// Every arm is asked and answered so often; a vendor's library with a clock of its own may differ a little.
inline constexpr int64_t kPeriodNs = 1'000'000;

struct ArmDescription {
    std::string name;  // "omega.6"
    uint64_t serial = 0;
    uint32_t firmware = 0;
    DeviceKind kind = DeviceKind::kBridge;
    bool has_orientation = false;
    double max_force = 0;         // N
    double max_torque = 0;        // N·m; 0 without torque
    double max_stiffness = 0;     // N/m; 0: not known
    double workspace_radius = 0;  // m around D's origin
    HandleDynamics handle = {};   // what is known of it
};

struct ArmReading {
    bool is_valid = false;    // the arm has said where it is, and X_DT is new
    bool has_failed = false;  // a call of this period returned an error
    Pose X_DT;
    bool has_velocity = false;  // otherwise the host differentiates
    Eigen::Vector3d v_DT = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_DT = Eigen::Vector3d::Zero();
    uint32_t buttons = 0;  // Button bits
    bool is_homed = false;
    bool is_powered = false;
    bool is_enabled = true;   // no switch of the arm forbids force
    uint32_t faults = 0;      // wire::Fault bits
    uint32_t fault_code = 0;  // the vendor's own number
    double load = 0;          // of the hottest motor, 0 to 1
};

struct ArmOrder {
    Wrench wrench_D;          // on the hand; finite, within the arm's limits
    bool is_driving = false;  // the host wants the motors on, if only with a zero wrench
};

// Answers a period of the arm. It neither blocks nor throws.
class ArmPeriod {
  public:
    virtual ~ArmPeriod() = default;
    // Whoever has the arm's clock calls it, once in every period, also when the arm did not say where it is.
    virtual ArmOrder step(const ArmReading& reading, int64_t now_ns) noexcept = 0;
};

// Takes one line about the library or the arm, for people.
using Tell = std::function<void(const std::string&)>;

class Arm {
  public:
    virtual ~Arm() = default;

    // Loads the vendor's library, finds the arm and opens it; gives no force. Throws UserError with the
    // reason.
    virtual ArmDescription open(const Tell& tell) = 0;
    // From now on `period` is asked in each period, on a thread of the arm. Throws UserError.
    virtual void start(ArmPeriod& period) = 0;
    // Takes the force away and releases the arm; nothing is asked afterwards. It may be called at any time,
    // and again, and lasts as long as the vendor's library does.
    virtual void stop() noexcept = 0;
};

}  // namespace bonemill::bridge
