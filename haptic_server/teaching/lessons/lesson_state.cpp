#include "haptic_server/teaching/lessons/lesson_state.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "common/attempts_csv/attempts_csv.h"
#include "common/text/foreign_text.h"

namespace bonemill {
namespace {

Answer answerTo(const topics::Command& order, const std::string& problem) {
    if (problem.empty()) return Answer::done();
    const bool is_of_another = order.action_case() == topics::Command::kStartAttempt;
    return Answer::failed(std::string(is_of_another ? "the attempt before" : "it") +
                          " is not in the class table: " + problem);
}

int64_t nowUnixNs() {
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
}

topics::Attempt onlyThatItWas(const topics::Attempt& attempt) {
    topics::Attempt told;
    told.set_number(attempt.number());
    told.set_trainee(attempt.trainee());
    told.set_scene_id(attempt.scene_id());
    told.set_start_stamp_ns(attempt.start_stamp_ns());
    told.set_time_s(attempt.time_s());
    told.set_is_exam(true);
    return told;
}

}  // namespace

LessonState::LessonState(std::vector<ListedScene> scenes, ClassTable table)
    : scenes_(std::move(scenes)), table_(std::move(table)) {
    for (const ListedScene& scene : scenes_) {
        topics::SceneChoice& choice = *lesson_.add_scenes();
        choice = scene.choice;
        choice.clear_picture();
    }
}

std::optional<topics::Lesson> LessonState::takeChanged() {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(has_changed_, false)) return std::nullopt;
    return lesson_;
}

void LessonState::enterScene(const std::string& file) {
    const std::lock_guard lock(mutex_);
    lesson_.set_scene_id(idOfScene(scenes_, file));
    for (size_t n = 0; n < scenes_.size(); ++n)
        if (lesson_.scenes(int(n)).is_made_first())
            lesson_.mutable_scenes(int(n))->set_is_made_first(lacksFiles(scenes_[n]));
    has_changed_ = true;
}

std::optional<Answer> LessonState::orderScene(const topics::Command& command) {
    const std::lock_guard lock(mutex_);
    const std::string& id = command.choose_scene();
    const auto scene = std::find_if(scenes_.begin(), scenes_.end(),
                                    [&](const ListedScene& s) { return s.choice.id() == id; });
    if (scene == scenes_.end())
        return Answer::refused("there is no scene '" + repeatedText(id) +
                               "'; haptic_server --list-scenes shows which there are");
    if (!lesson_.changing_to().empty())
        return Answer::refused("the scene " + lesson_.changing_to() + " is on its way; wait for it");
    lesson_.set_changing_to(id);
    has_changed_ = true;
    order_ = SceneOrder{command, scene->file};
    return std::nullopt;
}

std::optional<LessonState::SceneOrder> LessonState::takeOrder() {
    const std::lock_guard lock(mutex_);
    return std::exchange(order_, std::nullopt);
}

void LessonState::answerOrder(const topics::Command& command, const Answer& answer) {
    const std::lock_guard lock(mutex_);
    lesson_.clear_changing_to();
    has_changed_ = true;
    answers_.emplace_back(command, answer);
}

void LessonState::answerLater(const topics::Command& command, const Answer& answer) {
    const std::lock_guard lock(mutex_);
    answers_.emplace_back(command, answer);
}

std::vector<std::pair<topics::Command, Answer>> LessonState::takeAnswers() {
    const std::lock_guard lock(mutex_);
    for (const TableWriter::Written& written : table_.takeWritten()) {
        if (written.order) answers_.emplace_back(*written.order, answerTo(*written.order, written.problem));
        if (written.verdict) takeVerdict(written.attempt, *written.verdict);
    }
    return std::exchange(answers_, {});
}

void LessonState::takeVerdict(uint32_t attempt, const topics::Verdict& verdict) {
    for (topics::Attempt& kept : *lesson_.mutable_attempts())
        if (kept.number() == attempt) *kept.mutable_verdict() = verdict;
    has_changed_ = true;
}

// What Protobuf has parsed is UTF-8.
std::string LessonState::traineeProblem(const std::string& trainee) {
    if (trainee.find_first_not_of(' ') == std::string::npos) return "give the trainee's name or number";
    if (trainee.size() > kLongestTrainee)
        return "the trainee's name has " + std::to_string(trainee.size()) + " bytes; " +
               std::to_string(kLongestTrainee) + " at most";
    if (hasUnprintable(trainee))
        return "the name '" + repeatedText(trainee) + "' has characters that cannot be printed";
    return "";
}

void LessonState::beginAttempt(const std::string& trainee) {
    const std::lock_guard lock(mutex_);
    ++attempts_begun_;
    lesson_.set_is_running(true);
    lesson_.set_trainee(trainee);
    lesson_.set_start_stamp_ns(nowUnixNs());
    has_changed_ = true;
}

bool LessonState::isAttemptRunning() const {
    const std::lock_guard lock(mutex_);
    return lesson_.is_running();
}

int LessonState::attemptsOf(const std::string& trainee) const {
    const std::lock_guard lock(mutex_);
    const auto is_one = [&](const topics::Attempt& attempt) {
        return attempt.trainee() == trainee && attempt.scene_id() == lesson_.scene_id();
    };
    return int(std::ranges::count_if(lesson_.attempts(), is_one)) +
           (lesson_.is_running() && lesson_.trainee() == trainee ? 1 : 0);
}

void LessonState::dropAttempt() {
    const std::lock_guard lock(mutex_);
    --attempts_begun_;
    lesson_.set_is_running(false);
    has_changed_ = true;
}

void LessonState::endAttempt(topics::Attempt attempt, const std::optional<topics::Command>& order,
                             std::optional<AttemptJudgement> judgement, Told told) {
    const std::lock_guard lock(mutex_);
    lesson_.set_is_running(false);
    attempt.set_number(attempts_begun_);
    attempt.set_trainee(lesson_.trainee());
    attempt.set_scene_id(lesson_.scene_id());
    attempt.set_start_stamp_ns(lesson_.start_stamp_ns());
    if (!table_.write(attempt, sceneTitle(lesson_, attempt.scene_id()), order, std::move(judgement))) {
        const std::string problem = "too many lines wait for its disk, which hangs";
        spdlog::error("attempt {} is not in the class table: {}", attempts_begun_, problem);
        if (order) answers_.emplace_back(*order, answerTo(*order, problem));
    }
    auto& attempts = *lesson_.mutable_attempts();
    if (attempts.size() == kMaxAttempts) attempts.DeleteSubrange(0, 1);
    *attempts.Add() = told == Told::kAll ? std::move(attempt) : onlyThatItWas(attempt);
    has_changed_ = true;
}

}  // namespace bonemill
