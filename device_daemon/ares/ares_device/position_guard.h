// Decides whether six slider positions may be believed, and remembers why not.
//
// Belief begins when the device says that it is calibrated and, if the home place is known, every slider is
// where it is with the handle in that place. It ends with the first sign that an encoder lies; from then on
// nothing is believed, calibrated or not, until a user orders a reset with the handle in the home place, or
// the device homes again. Without a home place a reset alone brings the belief back, and an offset that
// stayed is not found. It is RT-safe, for one thread.
#pragma once

#include <optional>

#include "device_daemon/ares/ares_device/sensor_checks.h"
#include "device_daemon/ares/ares_device/slider_speed.h"
#include "device_daemon/ares/driver/joint_device.h"
#include "device_daemon/ares/driver/jump_check.h"
#include "device_daemon/ares/kinematics/pose_search.h"

namespace bonemill {

// Where the handle stands after homing: in its holder, or at a stop.
struct HomePlace {
    Pose X_DT;
    double tolerance = 3e-3;  // m, of every slider
};

struct PositionGuardConfig {
    double largest_slider_speed = 3;  // m/s: a hand at 1 m/s, with links leaning to their limit
    double encoder_step = 5e-6;       // m
    double friction = 0.2;            // N at the handle
    double stuck_travel = StuckCheck::kTravel;
    bool has_frozen_check = true;  // a simulated hand rests to the bit, and would look frozen
    std::optional<HomePlace> home;
    Pose X_DT_start;  // where the search for the first pose begins, without a home place
};

bool isFinite(const JointReading& joints) noexcept;

class PositionGuard {
  public:
    PositionGuard(const AresKinematics& kinematics, const PositionGuardConfig& config) noexcept;

    // Takes the next reading, `elapsed` s after the last one by the loop's clock; where the joints say when
    // they were read, and that is longer, it counts. `push` (N) is what the motors were told to push the hand
    // with in that time. True says that location() is where the handle is.
    bool take(const JointReading& joints, const Eigen::Vector3d& push, double elapsed) noexcept;
    // Gives the positions another chance.
    void reset() noexcept;

    // Tells whether the positions count from a zero that may be believed.
    bool isCalibrated() const noexcept { return is_trusted_; }
    // Says why the last reading was refused; kNone where it was believed, and before calibration.
    StopCause cause() const noexcept { return cause_; }
    // Returns where the last reading is, and how fast its sliders are.
    const Location& location() const noexcept { return location_; }
    const Vector6d& sliderSpeed() const noexcept { return q_dot_; }

  private:
    double sinceLast(const JointReading& joints) noexcept;
    bool begin(const Vector6d& q) noexcept;
    StopCause doubtOf(const Vector6d& q, const Eigen::Vector3d& push, double elapsed) noexcept;
    StopCause refusalOf(const Location& location) const noexcept;
    bool isNearAStop() const noexcept;
    bool distrust(StopCause cause) noexcept;

    AresKinematics kinematics_;
    PositionGuardConfig config_;
    Vector6d q_home_ = Vector6d::Zero();
    JumpCheck jump_;  // of any slider
    Vector6d q_last_ = Vector6d::Zero();
    StuckCheck stuck_;
    FrozenCheck frozen_;
    SliderSpeed speed_;
    Vector6d q_dot_ = Vector6d::Zero();
    Location location_;
    double since_finite_ = 0;  // s by the loop's clock, since the last reading of numbers
    int64_t taken_ns_ = 0;     // by the joints' clock: that reading
    bool is_trusted_ = false;
    bool is_distrusted_ = false;  // until a reset
    StopCause cause_ = StopCause::kNone;
};

}  // namespace bonemill
