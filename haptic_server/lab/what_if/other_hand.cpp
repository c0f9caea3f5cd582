#include "haptic_server/lab/what_if/other_hand.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

// From 0 to 1 without a jerk.
double smoothShare(double share) {
    const double x = std::clamp(share, 0.0, 1.0);
    return x * x * x * (10 + x * (6 * x - 15));
}

Eigen::Quaterniond quaternionOf(const TickInput& input) {
    return {input.q_WT[0], input.q_WT[1], input.q_WT[2], input.q_WT[3]};
}

void setPose(const Pose& X_WT, TickInput& input) {
    Eigen::Map<Eigen::Vector3d>(input.p_WT) = X_WT.position;
    const Eigen::Quaterniond& q = X_WT.rotation;
    input.q_WT[0] = q.w(), input.q_WT[1] = q.x(), input.q_WT[2] = q.y(), input.q_WT[3] = q.z();
}

// A share of the way from one hand to the other.
Pose poseBetween(const TickInput& from, const Pose& to, double share) {
    const Eigen::Vector3d p(from.p_WT);
    return {p + share * (to.position - p), quaternionOf(from).normalized().slerp(share, to.rotation)};
}

Pose poseOf(const TickInput& input) {
    return {Eigen::Vector3d(input.p_WT), quaternionOf(input).normalized()};
}

int64_t nsOf(double seconds) {
    return std::llround(seconds * double(kNsPerSecond));
}

}  // namespace

OtherHand::OtherHand(const Recording& recording, const Otherwise& otherwise, TickSpan attempt, uint64_t first,
                     double dt)
    : otherwise_(otherwise), attempt_(attempt), first_(first), dt_(dt), ticks_(recording) {
    at_moment_ = ticks_.at(first);
    if (!otherwise_.expert) return;
    attempt_time_ = attemptTime();
    if (!at_moment_.device.isEngaged())
        throw UserError("nobody holds the tool at that moment: the expert cannot take it");
    if (!otherwise_.expert->at(attempt_time_ + kHandOver))
        throw UserError("the expert's way does not cover that moment, " + std::to_string(attempt_time_) +
                        " s after the attempt began: take an earlier one");
}

double OtherHand::attemptTime() {
    uint64_t held = 0;
    for (uint64_t tick = attempt_.begin; tick < first_; ++tick)
        held += ticks_.at(tick).input.decisions.is_milling_paused ? 0 : 1;
    return double(held) * dt_;
}

std::optional<JournalTick> OtherHand::tick(uint64_t k) {
    std::optional<JournalTick> tick = otherwise_.expert ? experts(k) : recorded(k);
    if (!tick) return tick;
    if (otherwise_.tool) tick->input.decisions.tool = *otherwise_.tool;
    if (otherwise_.accuracy) tick->input.decisions.accuracy = *otherwise_.accuracy;
    if (!otherwise_.shift_W.isZero())
        Eigen::Map<Eigen::Vector3d>(tick->input.p_WT) +=
            smoothShare(double(k) * dt_ / kMove) * otherwise_.shift_W;
    return tick;
}

std::optional<JournalTick> OtherHand::recorded(uint64_t k) {
    if (otherwise_.pace != 1) return between(double(first_) + double(k) * otherwise_.pace, k);
    if (first_ + k >= attempt_.end) return std::nullopt;
    return ticks_.at(first_ + k);
}

// What was decided for the tick before holds; the hand is where it was on its way to the next one, unless it
// was placed anew there.
std::optional<JournalTick> OtherHand::between(double place, uint64_t k) {
    if (place > double(attempt_.end - 1)) return std::nullopt;
    const auto before = uint64_t(place);
    JournalTick tick = ticks_.at(before);
    if (before + 1 < attempt_.end) {
        const JournalTick& next = ticks_.at(before + 1);
        if (next.input.placements == tick.input.placements)
            setPose(poseBetween(tick.input, poseOf(next.input), place - double(before)), tick.input);
    }
    tick.start_ns = at_moment_.start_ns + nsOf(double(k) * dt_);
    tick.input.periods = 1;
    return tick;
}

std::optional<JournalTick> OtherHand::experts(uint64_t k) {
    const double t = double(k) * dt_;
    const std::optional<Pose> X_WT = otherwise_.expert->at(attempt_time_ + t);
    if (!X_WT) return std::nullopt;
    JournalTick tick = at_moment_;
    setPose(poseBetween(at_moment_.input, *X_WT, smoothShare(t / kHandOver)), tick.input);
    tick.buttons = t < kHandOver ? 0 : uint32_t(kButtonRemove);
    tick.start_ns = at_moment_.start_ns + nsOf(t);
    TickDecisions& decisions = tick.input.decisions;
    decisions.is_milling_paused = decisions.is_write_refused = false;
    decisions.is_milling_put_off = decisions.is_heat_put_off = false;
    tick.input.periods = 1;
    return tick;
}

}  // namespace bonemill
