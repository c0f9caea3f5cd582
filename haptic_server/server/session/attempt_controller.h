// Begins and ends a trainee's attempt at the scene in force, and counts what it came to. All members belong
// to the publisher thread, or to whoever has joined it.
#pragma once

#include <spdlog/spdlog.h>

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/commands/answer.h"
#include "common/config/scene_file.h"
#include "common/rt/clock.h"
#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/server/session/journal_recorder.h"
#include "haptic_server/server/session/recorder.h"
#include "haptic_server/server/session/shown_effects.h"
#include "haptic_server/server/session/task_monitor.h"
#include "haptic_server/teaching/attempt_report/report_words.h"
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
                      double voxel_volume, const scene::Scene& scene,
                      std::function<void(bool begins)> tell_device = {}, TaskMonitor* task = nullptr)
        : book_(book),
          recorder_(recorder),
          history_(history),
          journal_(journal),
          voxel_mm3_(voxel_volume * kPerCubicMillimetre),
          effects_(scene.effects()),
          tell_device_(std::move(tell_device)),
          task_(task),
          material_names_(materialNamesOf(scene)),
          scene_hash_(sceneHashOf(scene)),
          told_(scene.assessment().exam() ? LessonState::Told::kOnlyThatItWas : LessonState::Told::kAll) {}

    // The bone goes back to the scan, and milling goes on. Where
    // an attempt that is recorded ends with the order, the answer comes with LessonState::takeAnswers().
    std::optional<Answer> start(const topics::Command& order) {
        const std::string& trainee = order.start_attempt();
        if (const std::string problem = LessonState::traineeProblem(trainee); !problem.empty())
            return Answer::refused(problem);
        if (const std::string problem = limitProblem(trainee); !problem.empty())
            return Answer::refused(problem);
        const bool is_answered_later = book_.isAttemptRunning() && end(order);
        if (task_) task_->beginAttempt();
        journal_.expectPutBack(Checkpoints::kScannedBone);
        const uint64_t bone_order = history_.restore();
        recorder_.beginAttempt(bone_order);
        history_.pauseMilling(false);
        time_s_ = 0;
        counted_ns_ = monotonicNowNs();
        book_.beginAttempt(trainee);
        journal_.noteAttemptBegan(trainee, bone_order);
        if (tell_device_) tell_device_(true);
        if (is_answered_later) return std::nullopt;
        return Answer::done();
    }
    // Likewise; milling is paused until it is resumed, or another attempt begins.
    std::optional<Answer> stop(const topics::Command& order) {
        if (!book_.isAttemptRunning()) return Answer::refused("no attempt is under way");
        const bool is_answered_later = end(order);
        history_.pauseMilling(true);
        if (tell_device_) tell_device_(false);
        if (is_answered_later) return std::nullopt;
        return Answer::done();
    }
    // Ends the attempt under way, if there is one, without an order.
    void stop() {
        if (book_.isAttemptRunning()) end(std::nullopt);
    }
    // The bone was put back by an order. Outside of an attempt figures count from there.
    void noteRestored() {
        if (!book_.isAttemptRunning()) recorder_.beginAttempt(history_.newestOrder());
    }
    // Counts the time, which rests while milling is paused: call at least some times per second. An attempt
    // whose time is over ends.
    void round() {
        countTime();
        if (!task_ || !task_->task() || task_->task()->time_limit_s <= 0) return;
        if (!book_.isAttemptRunning() || time_s_ < task_->task()->time_limit_s) return;
        spdlog::info("the time for the attempt is over");
        end(std::nullopt);
        history_.pauseMilling(true);
        if (tell_device_) tell_device_(false);
    }
    double timeS() const noexcept { return time_s_; }  // of the attempt under way, or the last one
    bool isRunning() const { return book_.isAttemptRunning(); }

  private:
    static JudgedAttempt judgedAttempt(const Technique& technique, const TaskMonitor::Result& of_task) {
        if (!of_task.problem.empty()) throw std::runtime_error(of_task.problem);
        JudgedAttempt judged{of_task.assessment, {}};
        judged.assessment.series = technique.series();
        judged.assessment.moments = technique.moments();
        if (!of_task.picture.png.empty())
            judged.pictures.push_back(
                {deviationCaption(of_task.picture.scale), "image/png", of_task.picture.png});
        return judged;
    }

    void countTime() {
        const int64_t now_ns = monotonicNowNs();
        if (!history_.isMillingPaused()) time_s_ += secondsOfNs(now_ns - counted_ns_);
        counted_ns_ = now_ns;
    }
    std::string limitProblem(const std::string& trainee) const {
        if (!task_ || !task_->task() || task_->task()->most_attempts == 0) return "";
        if (book_.attemptsOf(trainee) < task_->task()->most_attempts) return "";
        return "'" + trainee + "' has had all " + std::to_string(task_->task()->most_attempts) +
               " attempts at this scene (assessment.most_attempts)";
    }
    // Returns true if the order is answered when the attempt is in the class table.
    bool end(const std::optional<topics::Command>& order) {
        countTime();
        // While the bone is still going back to the scan nothing was removed.
        const int64_t removed_voxels = history_.isRestoring() ? 0 : history_.missingVoxels();
        if (removed_voxels == 0 && time_s_ < kShortest) {
            journal_.noteAttemptDropped();
            book_.dropAttempt();
            return false;
        }
        const AttemptFigures figures = recorder_.attempt();
        topics::Attempt attempt;
        attempt.set_time_s(time_s_);
        attempt.set_removed_mm3(double(removed_voxels) * voxel_mm3_);
        attempt.set_max_force_n(figures.max_force);
        effects_.describe(figures.effects, material_names_, attempt);
        journal_.noteAttemptEnded(attempt);
        book_.endAttempt(std::move(attempt), order, judgement(figures.breach), told_);
        return true;
    }
    // The judging of the bone has begun when this returns. Of an attempt that no tick has seen there is
    // nothing to tell.
    std::optional<AttemptJudgement> judgement(std::optional<double> breach) {
        const std::shared_ptr<Technique> technique = recorder_.takeTechnique();
        if (technique) technique->finish();
        std::shared_future<TaskMonitor::Result> judged;
        if (task_) judged = task_->endAttempt(breach, technique ? technique->figures() : Figures{});
        if (!technique || technique->isEmpty()) return std::nullopt;
        AttemptJudgement judgement;
        judgement.scene_hash = scene_hash_;
        judgement.begin_s = technique->beginS();
        judgement.journal = journal_.fileName();
        if (const JudgedTask* const task = task_ ? task_->task() : nullptr) {
            judgement.is_exam = task->is_exam;
            judgement.is_told = !task->is_exam && task->feedback != TaskFeedback::kNever;
        }
        judgement.judge = [technique, judged] {
            return judged.valid() ? judgedAttempt(*technique, judged.get())
                                  : JudgedAttempt{technique->assessment(), {}};
        };
        return judgement;
    }

    LessonState& book_;
    Recorder& recorder_;
    BoneHistory& history_;
    JournalRecorder& journal_;
    double voxel_mm3_;
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
