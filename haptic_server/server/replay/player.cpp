#include "haptic_server/server/replay/player.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/base/units.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kLook = 2ms;                                  // for ticks that are due
constexpr int64_t kLongestRoundNs = 20 * kNsPerMillisecond;  // then orders are looked at
// A replay that falls behind by more than this goes on from where it is: it plays more slowly than asked.
constexpr int64_t kMaxBehindNs = 50 * kNsPerMillisecond;
// "The event before" is not the one that was just jumped to while the replay plays on.
constexpr double kSameMomentS = 0.7;
constexpr double kMaxMetres = 1e3;
constexpr int64_t kRecordPeriodNs = kNsPerMillisecond;  // as if ticks came so

}  // namespace

Player::Player(const Recording& recording, Rerun& rerun, const Keyframes& keyframes,
               const ReplayEvents& events, const Survey& survey, const Pose& X_VW,
               SpscRing<TickRecord>& telemetry, SpscRing<Cut>& cuts)
    : recording_(recording),
      rerun_(rerun),
      keyframes_(keyframes),
      events_(events),
      survey_(survey),
      X_VW_(X_VW),
      telemetry_(telemetry),
      cuts_(cuts),
      starts_(recording) {}

void Player::run(const std::stop_token& stop) {
    first_ns_ = monotonicNowNs();
    while (!stop.stop_requested()) {
        const Orders orders = awaitOrders(stop);
        if (orders.goal) seekTo(*orders.goal, stop);
        if (!orders.plays) {
            clock_speed_ = 0;
            continue;
        }
        if (orders.goal || orders.speed != clock_speed_) setClock(orders.speed);
        if (!playDue()) pauseAtEnd();
    }
}

// While it plays it looks again soon, for the ticks that are due.
Player::Orders Player::awaitOrders(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    if (is_playing_)
        changed_.wait_for(lock, stop, kLook, [this] { return goal_.has_value(); });
    else
        changed_.wait(lock, stop, [this] { return goal_ || is_playing_; });
    is_seeking_ = goal_.has_value();
    return {std::exchange(goal_, std::nullopt), is_playing_, speed_};
}

// From now on the next tick, and those after it, are due when their time has come.
void Player::setClock(double speed) {
    clock_speed_ = speed;
    clock_start_ns_ = monotonicNowNs();
    recorded_start_ns_ = starts_.at(std::min(rerun_.next(), recording_.ticks() - 1)).start_ns;
}

int64_t Player::dueNs() {
    const int64_t recorded_ns = starts_.at(rerun_.next()).start_ns - recorded_start_ns_;
    return clock_start_ns_ + int64_t(double(recorded_ns) / clock_speed_);
}

// False at the end of the recording.
bool Player::playDue() {
    const int64_t round_start_ns = monotonicNowNs();
    while (!rerun_.isAtEnd()) {
        const int64_t now_ns = monotonicNowNs(), due_ns = dueNs();
        if (due_ns > now_ns || now_ns - round_start_ns > kLongestRoundNs) return true;
        if (now_ns - due_ns > kMaxBehindNs) setClock(clock_speed_);
        show(rerun_.step(), true);
    }
    return false;
}

void Player::pauseAtEnd() {
    const std::lock_guard lock(mutex_);
    if (!goal_) is_playing_ = false;
}

void Player::seekTo(const Goal& goal, const std::stop_token& stop) {
    const Keyframe from = keyframes_.before(goal.tick);
    const bool is_on_the_way = rerun_.next() <= goal.tick && rerun_.next() >= from.tick;
    if (!is_on_the_way) rerun_.startAt(from);
    const auto is_replaced = [&] {
        const std::lock_guard lock(mutex_);
        return goal_.has_value();
    };
    constexpr int kTicksPerLook = 64;
    const TickRecord* last = nullptr;
    for (int n = 0; rerun_.next() <= goal.tick && !stop.stop_requested(); ++n) {
        last = &rerun_.step();
        if (n % kTicksPerLook == kTicksPerLook - 1 && is_replaced()) break;
    }
    if (last) show(*last, false);
    const std::lock_guard lock(mutex_);
    is_seeking_ = goal_.has_value();
    event_ = goal.event;
}

// Viewers and recorder take the newest number for the newest record: it counts on, wherever the replay goes.
void Player::show(TickRecord record, bool is_new_cut) {
    {
        const std::lock_guard lock(mutex_);
        shown_ = rerun_.next() - 1;
    }
    record.tick = records_;
    record.start_ns = first_ns_ + int64_t(records_) * kRecordPeriodNs;
    ++records_;
    telemetry_.tryPush(record);
    if (is_new_cut) tellMesher(cuts_, record.cut);
}

uint64_t Player::shown() const {
    const std::lock_guard lock(mutex_);
    return shown_;
}

void Player::play(bool goes_on) {
    {
        const std::lock_guard lock(mutex_);
        is_playing_ = goes_on;
        const bool is_at_end = shown_ + 1 >= recording_.ticks() && !goal_;
        if (goes_on && is_at_end) goal_ = Goal{0, ""};  // from the beginning
        event_.clear();
    }
    changed_.notify_all();
}

Answer Player::carryOut(const topics::ReplayOrder& order) {
    switch (order.order_case()) {
        case topics::ReplayOrder::kSeekS:
            return seek(order.seek_s());
        case topics::ReplayOrder::kSpeed:
            return setSpeed(order.speed());
        case topics::ReplayOrder::kJump:
            return jump(order.jump());
        case topics::ReplayOrder::kRemovalAt:
            return goToRemoval(order.removal_at());
        default:
            break;
    }
    return Answer::refused("this replay does not know the order");
}

void Player::goTo(uint64_t tick, std::string event) {
    {
        const std::lock_guard lock(mutex_);
        goal_ = Goal{tick, std::move(event)};
        is_seeking_ = true;
        event_ = goal_->event;
    }
    changed_.notify_all();
}

Answer Player::seek(double seconds) {
    if (!(seconds >= 0)) return Answer::refused("there is no moment before the first one, 0 s");
    goTo(recording_.tickAt(seconds), "");
    return Answer::done();
}

Answer Player::setSpeed(double speed) {
    if (!(speed >= kSlowest && speed <= kFastest))
        return Answer::refused("a replay has a speed of 0.1 to 16");
    {
        const std::lock_guard lock(mutex_);
        speed_ = speed;
        event_.clear();
    }
    changed_.notify_all();
    return Answer::done();
}

Answer Player::jump(int32_t by) {
    const uint64_t now = shown();
    std::optional<ReplayEvent> event;
    if (by > 0) {
        event = events_.after(now);
        if (!event && survey_.known() < recording_.ticks())
            return Answer::refused(
                "no event is known yet after this one; the recording is still being looked "
                "through");
    } else if (by < 0) {
        const double moment_s = recording_.secondsOf(now) - sameMomentS();
        event = events_.before(moment_s > 0 ? recording_.tickAt(moment_s) : 0);
    }
    if (!event)
        return Answer::refused(by < 0 ? "there is no event before this one"
                                      : "there is no event after this one");
    goTo(event->tick, timeText(event->tick) + ": " + event->text);
    return Answer::done();
}

double Player::sameMomentS() const {
    const std::lock_guard lock(mutex_);
    return is_playing_ ? kSameMomentS * speed_ : 0;
}

Answer Player::goToRemoval(const topics::Place& place) {
    if (place.p_m_size() != 3 ||
        !std::ranges::all_of(place.p_m(), [](double part) { return std::abs(part) < kMaxMetres; }))
        return Answer::refused("that is no place");
    const Eigen::Vector3d p_V = X_VW_ * Eigen::Vector3d(place.p_m().data());
    const auto removal = survey_.removals().nearest(p_V, kPlaceRadius, shown());
    if (!removal)
        return Answer::refused("no bone was removed within 2 mm of there" +
                               (survey_.known() < recording_.ticks()
                                    ? " in the first " + timeText(survey_.known()) +
                                          ", and the rest is still being looked through"
                                    : std::string()));
    goTo(removal->tick, timeText(removal->tick) + ": removed here, in tick " + std::to_string(removal->tick));
    return Answer::done();
}

std::string Player::timeText(uint64_t tick) const {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f s", recording_.secondsOf(std::min(tick, recording_.ticks() - 1)));
    return text;
}

void Player::describe(topics::Replay& replay) const {
    replay.set_length_s(recording_.lengthS());
    replay.set_known_s(recording_.secondsOf(std::min(survey_.known(), recording_.ticks() - 1)));
    const std::lock_guard lock(mutex_);
    replay.set_speed(speed_);
    replay.set_is_playing(is_playing_);
    replay.set_is_seeking(is_seeking_);
    replay.set_event(event_);
}

}  // namespace bonemill
