// Begins and ends a trainee's attempt at the scene in force, and counts what it came to. All members belong
// to the publisher thread, or to whoever has joined it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/commands/answer.h"
#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/server/session/journal_notes.h"
#include "haptic_server/server/session/shown_effects.h"
#include "haptic_server/server/session/task_monitor.h"
#include "haptic_server/server/session/tick_recorder.h"
#include "haptic_server/teaching/lessons/lesson_state.h"

namespace bonemill {

class AttemptController {
  public:
    // A shorter attempt that removed nothing was begun by mistake: it counts as none.
    static constexpr double kShortest = 2;  // s

    // References must outlive this object. `tell_device` is told when an attempt begins (true) and when the
    // one under way ends without another. `task` (null: none) has each attempt judged, and may limit their
    // number and time.
    AttemptController(LessonState& book, Recorder& recorder, BoneHistory& history, JournalRecorder& journal,
                      const BoneModel& bone, const scene::Scene& scene,
                      std::function<void(bool begins)> tell_device = {}, TaskMonitor* task = nullptr);

    // The bone goes back to the scan, and milling goes on. Where
    // an attempt that is recorded ends with the order, the answer comes with LessonState::takeAnswers().
    std::optional<Answer> start(const topics::Command& order);
    // Likewise; milling is paused until it is resumed, or another attempt begins.
    std::optional<Answer> stop(const topics::Command& order);
    // Ends the attempt under way, if there is one, without an order.
    void stop();
    // The bone was put back by an order. Outside of an attempt figures count from there.
    void noteRestored();
    // Counts the time, which rests while milling is paused: call at least some times per second. An attempt
    // whose time is over ends.
    void round();
    double timeS() const noexcept { return time_s_; }  // of the attempt under way, or the last one
    bool isRunning() const { return book_.isAttemptRunning(); }

  private:
    void countTime();
    std::string limitProblem(const std::string& trainee) const;
    // Returns true if the order is answered when the attempt is in the class table.
    bool end(const std::optional<topics::Command>& order);
    std::optional<AttemptJudgement> judgement(EndedAttempt ended, std::shared_ptr<const BoneSnapshot> bone);

    LessonState& book_;
    Recorder& recorder_;
    BoneHistory& history_;
    const BoneModel& bone_;
    JournalRecorder& journal_;
    ShownEffects effects_;
    std::function<void(bool begins)> tell_device_;
    TaskMonitor* task_;
    std::vector<std::string> material_names_;
    uint64_t scene_hash_;
    LessonState::Told told_;
    double time_s_ = 0;
    int64_t counted_ns_ = 0;  // CLOCK_MONOTONIC until which it is counted
};

}  // namespace bonemill
