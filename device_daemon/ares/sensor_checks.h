// What six encoders can tell of their own faults. Six positions fix six degrees of freedom exactly: one that
// is wrong gives a pose that looks as well as any, and only time, or a place that is known, shows it.
//
// Found: a joint that jumps (JumpCheck, in one period); one that stands still while the handle moves
// (StuckCheck, once it has moved kStuckTravel); a whole reading that stands still while the hand is pushed
// (FrozenCheck, after kFrozenTime); an offset from before the start, if the handle stands in its home place
// then (isAtHome). Not found: an offset below the home tolerance; a joint that slips more slowly than a hand
// moves; a stuck joint while the handle rests, or moves less than kStuckTravel: until then the pose is wrong
// by about that travel; a frozen reading while the motors push no harder than friction; and a stuck joint or
// frozen reading within kStopMargin of the end of the workspace, where a stop may hold a slider as still.
//
// Everything is RT-safe, for one thread, and pure: time comes in as a parameter. Units are m, s, N.
#pragma once

#include <array>

#include "common/geometry/pose.h"

namespace bonemill {

inline constexpr double kStopMargin = 1e-3;  // m

// A slider farther from where it was than its largest speed allows has slipped, or its encoder has.
class JumpCheck {
  public:
    JumpCheck(double largest_speed, double encoder_step) noexcept
        : largest_speed_(largest_speed), slack_(kSlackSteps * encoder_step) {}

    // Restarts from these positions.
    void restart(const Vector6d& q) noexcept { q_last_ = q; }
    // Tells whether any slider jumped in the `elapsed` s since the last call.
    bool jumped(const Vector6d& q, double elapsed) noexcept;

    static constexpr double kSlackSteps = 4;

  private:
    double largest_speed_;  // m/s
    double slack_;          // m
    Vector6d q_last_ = Vector6d::Zero();
};

// A slider that stands still to the last bit while three of the other five have moved is stuck. A hand
// trembles by many encoder steps, so that no joint keeps its position while the handle goes kStuckTravel. A
// simulated hand without tremor is smoother: along 60000 random smooth moves through the specified workspace
// a sound joint stood still for 4.7 mm of the others once in 1000 moves, and for 12.1 mm at most.
class StuckCheck {
  public:
    StuckCheck(double travel, double stroke) noexcept : travel_(travel), stroke_(stroke) {}

    void restart(const Vector6d& q) noexcept;
    bool isStuck(const Vector6d& q) noexcept;

    static constexpr double kTravel = 5e-3;         // m, with a hand that trembles
    static constexpr double kSmoothTravel = 20e-3;  // m, with a simulated hand

  private:
    bool standsAtItsStop(double position) const noexcept;
    double travelSinceItMoved(const Vector6d& q, int joint) const noexcept;

    double travel_;  // m
    double stroke_;  // m
    Vector6d q_last_ = Vector6d::Zero();
    std::array<Vector6d, 6> q_when_it_moved_{};  // all positions, when joint i last changed
};

// A reading in which no slider moves at all while the motors push the hand harder than friction holds is no
// reading. The push is the one that was ordered, because measured forces may be frozen with the rest.
// Weight and its compensation do not count: they push nothing. A hand that answers a push exactly to within
// friction for kFrozenTime is not known; a clamp that holds the handle would be, and raises a false alarm.
class FrozenCheck {
  public:
    explicit FrozenCheck(double friction) noexcept : least_push_(kPushOverFriction * friction + kLeastPush) {}

    void restart() noexcept { frozen_for_ = 0; }
    // `push` (N) is what the motors were told to push the hand with since the last call.
    bool isFrozen(const Vector6d& q, double push, double elapsed) noexcept;

    static constexpr double kFrozenTime = 2;  // s
    static constexpr double kPushOverFriction = 2;
    static constexpr double kLeastPush = 1;  // N

  private:
    double least_push_;  // N
    double frozen_for_ = 0;
    Vector6d q_last_ = Vector6d::Zero();
};

// Tells whether every slider is where it is while the handle stands in its home place.
bool isAtHome(const Vector6d& q, const Vector6d& q_home, double tolerance) noexcept;

}  // namespace bonemill
