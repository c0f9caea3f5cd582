// Plays a recording: its ticks run on the player's thread when their time has come, at any speed, and what
// they tell goes where a live session's tick would put it. Orders come from the publisher thread, which does
// not wait.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "common/commands/answer.h"
#include "common/geometry/pose.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/server/replay/survey.h"
#include "proto/topics.pb.h"

namespace bonemill {

class Player {
  public:
    static constexpr double kSlowest = 0.1, kFastest = 16;
    // Bone within this distance of a place counts as there, m.
    static constexpr double kPlaceRadius = 2e-3;

    // All must outlive this object. X_VW leads into the bone's frame.
    Player(const Recording& recording, Rerun& rerun, const Keyframes& keyframes, const ReplayEvents& events,
           const Survey& survey, const Pose& X_VW, SpscRing<TickRecord>& telemetry, SpscRing<Cut>& cuts);

    // The player's thread: plays and does as ordered, until told to stop.
    void run(const std::stop_token& stop);

    // Lets the recording go on, or holds it.
    void play(bool goes_on);
    // To go to a moment, and the speed.
    Answer carryOut(const topics::ReplayOrder& order);
    void describe(topics::Replay& replay) const;

    // The tick that was shown last. Any thread.
    uint64_t shown() const;

  private:
    struct Goal {
        uint64_t tick;
        std::string event;
    };
    Answer seek(double seconds);
    Answer setSpeed(double speed);
    Answer jump(int32_t by);
    Answer goToRemoval(const topics::Place& place);
    double sameMomentS() const;
    std::string timeText(uint64_t tick) const;
    void goTo(uint64_t tick, std::string event);

    struct Orders {
        std::optional<Goal> goal;
        bool plays;
        double speed;
    };
    Orders awaitOrders(const std::stop_token& stop);
    void setClock(double speed);
    int64_t dueNs();
    bool playDue();
    void pauseAtEnd();
    void seekTo(const Goal& goal, const std::stop_token& stop);
    void show(TickRecord record, bool is_new_cut);

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
