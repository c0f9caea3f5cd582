// Plays a recording: its ticks run on the player's thread when their time has come, at any speed, and what
// they tell goes where a live session's tick would put it. Orders come from the publisher thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/commands/answer.h"
#include "common/rt/clock.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/server/replay/survey.h"
#include "haptic_server/server/session/session_commands.h"

namespace bonemill {

class Player final : public ReplayOrders {
  public:
    static constexpr double kSlowest = 0.1, kFastest = 16;
    // Bone within this distance of a place counts as there, m.
    static constexpr double kPlaceRadius = 2e-3;

    // All must outlive this object. X_VW leads into the bone's frame.
    Player(const Recording& recording, Rerun& rerun, const Keyframes& keyframes, const ReplayEvents& events,
           const Survey& survey, const Pose& X_VW, SpscRing<TickRecord>& telemetry, SpscRing<Cut>& cuts)
        : recording_(recording),
          rerun_(rerun),
          keyframes_(keyframes),
          events_(events),
          survey_(survey),
          X_VW_(X_VW),
          telemetry_(telemetry),
          cuts_(cuts),
          starts_(recording) {}

    // The player's thread: plays and does as ordered, until told to stop.
    void run(const std::stop_token& stop) {
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

    void play(bool goes_on) override {
        {
            const std::lock_guard lock(mutex_);
            is_playing_ = goes_on;
            const bool is_at_end = shown_ + 1 >= recording_.ticks() && !goal_;
            if (goes_on && is_at_end) goal_ = Goal{0, ""};  // from the beginning
            event_.clear();
        }
        changed_.notify_all();
    }
    Answer carryOut(const topics::ReplayOrder& order) override {
        switch (order.order_case()) {
            case topics::ReplayOrder::kSeekS:
                return seek(order.seek_s());
            case topics::ReplayOrder::kSpeed:
                return setSpeed(order.speed());
            case topics::ReplayOrder::kJump:
                return jump(order.jump());
            case topics::ReplayOrder::kRemovalAt:
                return goToRemoval(order.removal_at());
            case topics::ReplayOrder::ORDER_NOT_SET:
                break;
        }
        return Answer::refused("this replay does not know the order");
    }
    void describe(topics::Replay& replay) const override {
        replay.set_length_s(recording_.lengthS());
        replay.set_known_s(recording_.secondsOf(std::min(survey_.known(), recording_.ticks() - 1)));
        const std::lock_guard lock(mutex_);
        replay.set_speed(speed_);
        replay.set_is_playing(is_playing_);
        replay.set_is_seeking(is_seeking_);
        replay.set_event(event_);
    }

    // The tick that was shown last. Any thread.
    uint64_t shown() const {
        const std::lock_guard lock(mutex_);
        return shown_;
    }

  private:
    static constexpr std::chrono::milliseconds kLook{2};                // for ticks that are due
    static constexpr int64_t kLongestRoundNs = 20 * kNsPerMillisecond;  // then orders are looked at
    // A replay that falls behind by more than this goes on from where it is: it plays more slowly than asked.
    static constexpr int64_t kMaxBehindNs = 50 * kNsPerMillisecond;
    // "The event before" is not the one that was just jumped to while the replay plays on.
    static constexpr double kSameMomentS = 0.7;
    static constexpr double kMaxMetres = 1e3;
    static constexpr int64_t kRecordPeriodNs = kNsPerMillisecond;  // as if ticks came so

    struct Goal {
        uint64_t tick;
        std::string event;
    };
    Answer seek(double seconds) {
        if (!(seconds >= 0)) return Answer::refused("there is no moment before the first one, 0 s");
        goTo(recording_.tickAt(seconds), "");
        return Answer::done();
    }
    Answer setSpeed(double speed) {
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
    Answer jump(int32_t by) {
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
    Answer goToRemoval(const topics::Place& place) {
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
        goTo(removal->tick,
             timeText(removal->tick) + ": removed here, in tick " + std::to_string(removal->tick));
        return Answer::done();
    }
    double sameMomentS() const {
        const std::lock_guard lock(mutex_);
        return is_playing_ ? kSameMomentS * speed_ : 0;
    }
    std::string timeText(uint64_t tick) const {
        char text[32];
        std::snprintf(text, sizeof text, "%.2f s",
                      recording_.secondsOf(std::min(tick, recording_.ticks() - 1)));
        return text;
    }
    void goTo(uint64_t tick, std::string event) {
        {
            const std::lock_guard lock(mutex_);
            goal_ = Goal{tick, std::move(event)};
            is_seeking_ = true;
            event_ = goal_->event;
        }
        changed_.notify_all();
    }

    struct Orders {
        std::optional<Goal> goal;
        bool plays;
        double speed;
    };
    // While it plays it looks again soon, for the ticks that are due.
    Orders awaitOrders(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        if (is_playing_)
            changed_.wait_for(lock, stop, kLook, [this] { return goal_.has_value(); });
        else
            changed_.wait(lock, stop, [this] { return goal_ || is_playing_; });
        is_seeking_ = goal_.has_value();
        return {std::exchange(goal_, std::nullopt), is_playing_, speed_};
    }
    // From now on the next tick, and those after it, are due when their time has come.
    void setClock(double speed) {
        clock_speed_ = speed;
        clock_start_ns_ = monotonicNowNs();
        recorded_start_ns_ = starts_.at(std::min(rerun_.next(), recording_.ticks() - 1)).start_ns;
    }
    int64_t dueNs() {
        const int64_t recorded_ns = starts_.at(rerun_.next()).start_ns - recorded_start_ns_;
        return clock_start_ns_ + int64_t(double(recorded_ns) / clock_speed_);
    }
    // False at the end of the recording.
    bool playDue() {
        const int64_t round_start_ns = monotonicNowNs();
        while (!rerun_.isAtEnd()) {
            const int64_t now_ns = monotonicNowNs(), due_ns = dueNs();
            if (due_ns > now_ns || now_ns - round_start_ns > kLongestRoundNs) return true;
            if (now_ns - due_ns > kMaxBehindNs) setClock(clock_speed_);
            show(rerun_.step(), true);
        }
        return false;
    }
    void pauseAtEnd() {
        const std::lock_guard lock(mutex_);
        if (!goal_) is_playing_ = false;
    }
    void seekTo(const Goal& goal, const std::stop_token& stop) {
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
    // Viewers and recorder take the newest number for the newest record: it counts on, wherever the replay
    // goes.
    void show(TickRecord record, bool is_new_cut) {
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

    const Recording& recording_;
    Rerun& rerun_;
    const Keyframes& keyframes_;
    const ReplayEvents& events_;
    const Survey& survey_;
    const Pose X_VW_;
    SpscRing<TickRecord>& telemetry_;
    SpscRing<Cut>& cuts_;

    // The player's thread has these.
    RecordedTicks starts_;
    int64_t clock_start_ns_ = 0;     // CLOCK_MONOTONIC at which
    int64_t recorded_start_ns_ = 0;  // this moment of the recording was due
    double clock_speed_ = 0;         // 0: the clock stands
    uint64_t records_ = 0;           // that were shown
    int64_t first_ns_ = 0;

    mutable std::mutex mutex_;  // guards what is below
    std::condition_variable_any changed_;
    bool is_playing_ = true;
    double speed_ = 1;
    std::optional<Goal> goal_;  // not taken up yet
    bool is_seeking_ = false;
    std::string event_;
    uint64_t shown_ = 0;
};

}  // namespace bonemill
