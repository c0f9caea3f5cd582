#include "haptic_server/server/session/attempt_controller.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/base/units.h"
#include "common/config/scene_file.h"
#include "common/rt/clock.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {
namespace {

JudgedAttempt judgedAttempt(const Technique& technique, const TaskMonitor::Result& of_task) {
    if (!of_task.problem.empty()) throw std::runtime_error(of_task.problem);
    JudgedAttempt judged{of_task.assessment, {}};
    judged.assessment.series = technique.series();
    judged.assessment.moments = technique.moments();
    if (!of_task.picture.png.empty())
        judged.pictures.push_back(
            {deviationCaption(of_task.picture.scale), "image/png", of_task.picture.png});
    return judged;
}

}  // namespace

AttemptController::AttemptController(LessonState& book, Recorder& recorder, BoneHistory& history,
                                     JournalRecorder& journal, const BoneModel& bone,
                                     const scene::Scene& scene, std::function<void(bool begins)> tell_device,
                                     TaskMonitor* task)
    : book_(book),
      recorder_(recorder),
      history_(history),
      bone_(bone),
      journal_(journal),
      effects_(scene.effects()),
      tell_device_(std::move(tell_device)),
      task_(task),
      material_names_(materialNamesOf(scene)),
      scene_hash_(sceneHashOf(scene)),
      told_(scene.assessment().exam() ? LessonState::Told::kOnlyThatItWas : LessonState::Told::kAll) {}

std::optional<Answer> AttemptController::start(const topics::Command& order) {
    const std::string& trainee = order.start_attempt();
    if (const std::string problem = LessonState::traineeProblem(trainee); !problem.empty())
        return Answer::refused(problem);
    if (const std::string problem = limitProblem(trainee); !problem.empty()) return Answer::refused(problem);
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

std::optional<Answer> AttemptController::stop(const topics::Command& order) {
    if (!book_.isAttemptRunning()) return Answer::refused("no attempt is under way");
    const bool is_answered_later = end(order);
    history_.pauseMilling(true);
    if (tell_device_) tell_device_(false);
    if (is_answered_later) return std::nullopt;
    return Answer::done();
}

void AttemptController::stop() {
    if (book_.isAttemptRunning()) end(std::nullopt);
}

void AttemptController::noteRestored() {
    if (!book_.isAttemptRunning()) recorder_.beginAttempt(history_.newestOrder());
}

std::string AttemptController::limitProblem(const std::string& trainee) const {
    if (!task_ || !task_->task() || task_->task()->most_attempts == 0) return "";
    if (book_.attemptsOf(trainee) < task_->task()->most_attempts) return "";
    return "'" + trainee + "' has had all " + std::to_string(task_->task()->most_attempts) +
           " attempts at this scene (assessment.most_attempts)";
}

void AttemptController::round() {
    countTime();
    if (!task_ || !task_->task() || task_->task()->time_limit_s <= 0) return;
    if (!book_.isAttemptRunning() || time_s_ < task_->task()->time_limit_s) return;
    spdlog::info("the time for the attempt is over");
    end(std::nullopt);
    history_.pauseMilling(true);
    if (tell_device_) tell_device_(false);
}

void AttemptController::countTime() {
    const int64_t now_ns = monotonicNowNs();
    if (!history_.isMillingPaused()) time_s_ += secondsOfNs(now_ns - counted_ns_);
    counted_ns_ = now_ns;
}

bool AttemptController::end(const std::optional<topics::Command>& order) {
    countTime();
    // While the bone is still going back to the scan nothing was removed.
    const bool is_restoring = history_.isRestoring();
    const std::shared_ptr<const BoneSnapshot> bone = history_.snapshot(bone_);
    const int64_t removed_voxels = is_restoring ? 0 : bone->missing_voxels;
    if (removed_voxels == 0 && time_s_ < kShortest) {
        journal_.noteAttemptDropped();
        book_.dropAttempt();
        return false;
    }
    EndedAttempt ended = recorder_.endAttempt(is_restoring ? 0 : bone->ticks);
    topics::Attempt attempt;
    attempt.set_time_s(time_s_);
    attempt.set_removed_mm3(double(removed_voxels) * bone_.volume.voxelVolume() * kPerCubicMillimetre);
    attempt.set_max_force_n(ended.figures.max_force);
    effects_.describe(ended.figures.effects, material_names_, attempt);
    journal_.noteAttemptEnded(attempt, ended.end);
    book_.endAttempt(std::move(attempt), order, judgement(std::move(ended), bone), told_);
    return true;
}

// The judging of the bone has begun when this returns. Of an attempt that no tick has seen there is nothing
// to tell.
std::optional<AttemptJudgement> AttemptController::judgement(EndedAttempt ended,
                                                             std::shared_ptr<const BoneSnapshot> bone) {
    const std::shared_ptr<Technique> technique = std::move(ended.technique);
    std::shared_future<TaskMonitor::Result> judged;
    if (task_)
        judged = task_->endAttempt(std::move(bone), ended.figures.breach,
                                   technique ? technique->figures() : Figures{});
    if (!technique || technique->isEmpty()) return std::nullopt;
    AttemptJudgement judgement;
    judgement.scene_hash = scene_hash_;
    judgement.begin_s = technique->beginS();
    judgement.journal = journal_.fileName();
    if (const auto newest = journal_.newestLink())
        judgement.link = [newest, count = newest->count()] {
            constexpr std::chrono::seconds kLongest{3};  // without a device there are no ticks, and no links
            return newest->awaitAfter(count, kLongest);
        };
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

}  // namespace bonemill
