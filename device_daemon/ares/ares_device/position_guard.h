// Decides whether six slider positions may be believed, and remembers why not.
//
// Belief begins when the device says that it is calibrated and, if the home place is known, every slider is
// where it is with the handle in that place. It ends with the first sign that an encoder lies; from then on
// nothing is believed, calibrated or not, until a user orders a reset with the handle in the home place, or
// the device homes again. Without a home place a reset alone brings the belief back, and an offset that
// stayed is not found.
//
// What six encoders can tell of their own faults. Six positions fix six degrees of freedom exactly: one that
// is wrong gives a pose that looks as well as any, and only time, or a place that is known, shows it.
//
// Found: a joint that jumps (JumpCheck, in one period); one that stands still while the handle moves
// (StuckCheck, once another joint has moved 2 mm if it stuck in motion, and kTravel otherwise); a whole
// reading that stands still while the push on the hand changes (FrozenCheck, in 0.1 s) or is steady (in 10
// s); an offset from before the start, if the handle stands in its home place then (isAtHome). Not found: an
// offset below the home tolerance; a joint that slips no faster than a hand moves; a stuck joint while the
// handle rests, or moves less than kTravel, so that until then the pose is wrong by about as much; a frozen
// reading while the motors push no harder than friction; and a stuck joint or a frozen reading within
// kStopMargin of the end of the workspace, where a stop may hold a slider as still.
//
// Everything is RT-safe, for one thread, and pure: time comes in as a parameter. Units are m, s, N.
#pragma once

#include <array>
#include <optional>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/geometry/pose.h"
#include "device_daemon/ares/driver/joint_device.h"
#include "device_daemon/ares/driver/jump_check.h"

namespace bonemill {

// Slider velocities (m/s) for joints that give none: differences of the positions, smoothed. Steps of 5 um in
// periods of 1 ms are steps of 5 mm/s; the filter makes 1 mm/s of them, and is 4 ms late.
class SliderSpeed {
  public:
    // Returns the velocities after the positions changed to q in `elapsed`; zero after the first call.
    const Vector6d& update(const Vector6d& q, double elapsed) noexcept {
        if (has_last_ && elapsed > 0) {
            const double share = elapsed / (elapsed + kFilterTime);
            q_dot_ += share * ((q - q_last_) / elapsed - q_dot_);
        }
        q_last_ = q;
        has_last_ = true;
        return q_dot_;
    }

    static constexpr double kFilterTime = 4e-3;  // s

  private:
    Vector6d q_last_ = Vector6d::Zero();
    Vector6d q_dot_ = Vector6d::Zero();
    bool has_last_ = false;
};

inline constexpr double kStopMargin = 1e-3;  // m

// A slider that stands still to the last bit while another one moves is stuck. A sound one does so for a
// while where it turns back: along 20000 random moves of 25 mm and 40 degrees in a second, with a tremor of
// 50 um, while another moved 5 mm once in 1000 moves, and 8.7 mm at most; without tremor 8 mm and 21 mm. But
// a slider that turns back is slow before: one that stops dead is found sooner.
class StuckCheck {
  public:
    // `travel` (m) is how far another slider may move, while one stands still that has not stopped dead.
    StuckCheck(double travel, double stroke) noexcept : travel_(travel), stroke_(stroke) {}

    void restart(const Vector6d& q) noexcept;
    bool isStuck(const Vector6d& q, double elapsed) noexcept;

    static constexpr double kTravel = 12e-3;        // m, with a hand that trembles
    static constexpr double kSmoothTravel = 30e-3;  // m, with a simulated hand
    static constexpr double kDeadStopTravel = 2e-3;
    // A slider turns back within a step of 5 um at this speed (m/s) only if it is braked by 40 m/s².
    static constexpr double kDeadStopSpeed = 0.02;

  private:
    bool standsAtItsStop(double position) const noexcept;

    double travel_;  // m
    double stroke_;  // m
    SliderSpeed speed_;
    Vector6d q_last_ = Vector6d::Zero();
    std::array<Vector6d, 6> q_when_it_moved_{};     // all positions, when slider i last changed
    std::array<bool, 6> was_fast_when_it_moved_{};  // faster than kDeadStopSpeed
};

// A reading in which no slider moves at all while the hand is pushed is no reading. Friction may hold a
// handle that the hand pushes back, but not when the push changes by more than friction takes up either way;
// and no hand answers a steady push to within friction for kSteadyTime. (A clamp does: it raises a false
// alarm, as a hand that rests in it might.) The push is the one that was ordered, because measured forces may
// be frozen with the rest. Weight and what holds it do not count: they push nothing.
class FrozenCheck {
  public:
    explicit FrozenCheck(double friction) noexcept : least_push_(2 * friction + kMinPush) {}

    // Begins a new stretch of stillness at the next call.
    void restart() noexcept { has_last_ = false; }
    // `push` (N) is what the motors were told to push the hand with since the last call.
    bool isFrozen(const Vector6d& q, const Eigen::Vector3d& push, double elapsed) noexcept;

    static constexpr double kChangedTime = 0.1;  // s, after the push has changed
    static constexpr double kSteadyTime = 10;    // s
    static constexpr double kMinPush = 1;        // N, beyond twice the friction

  private:
    double least_push_;  // N
    bool has_last_ = false;
    Vector6d q_last_ = Vector6d::Zero();
    // Of the stretch in which nothing has moved:
    Eigen::Vector3d lowest_push_ = Eigen::Vector3d::Zero(), highest_push_ = Eigen::Vector3d::Zero();
    double changed_for_ = 0, pushed_for_ = 0;  // s
};

// Tells whether every slider is where it is while the handle stands in its home place.
bool isAtHome(const Vector6d& q, const Vector6d& q_home, double tolerance) noexcept;

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
