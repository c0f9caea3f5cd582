// What the server can teach, teaches, and how attempts went: it lives as long as the process, and scenes come
// and go.
//
// Any normal thread may call it. It takes a mutex, so it is not for the tick.
#pragma once

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/attempts_csv/attempts_csv.h"
#include "common/commands/answer.h"
#include "common/text/foreign_text.h"
#include "haptic_server/teaching/lessons/class_table.h"
#include "haptic_server/teaching/lessons/scene_folder.h"
#include "proto/topics.pb.h"

namespace bonemill {

class LessonState {
  public:
    static constexpr int kMaxAttempts = 256;
    static constexpr size_t kLongestTrainee = 48;  // bytes

    LessonState(std::vector<ListedScene> scenes, ClassTable table)
        : scenes_(std::move(scenes)), table_(std::move(table)) {
        for (const ListedScene& scene : scenes_) {
            topics::SceneChoice& choice = *lesson_.add_scenes();
            choice = scene.choice;
            choice.clear_picture();
        }
    }

    // The publisher thread asks what is to be shown, once per change; the epoch is still missing, and so are
    // the pictures of the scenes, which never change.
    std::optional<topics::Lesson> takeChanged() {
        const std::lock_guard lock(mutex_);
        if (!std::exchange(has_changed_, false)) return std::nullopt;
        return lesson_;
    }
    const std::vector<ListedScene>& scenes() const noexcept { return scenes_; }
    // The scene of this file is in force now: it is told anew.
    void enterScene(const std::string& file) {
        const std::lock_guard lock(mutex_);
        lesson_.set_scene_id(idOfScene(scenes_, file));
        has_changed_ = true;
    }

    // A client asks for another scene. The answer is the refusal, or nothing: then it comes with
    // takeAnswers().
    std::optional<Answer> orderScene(const topics::Command& command) {
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
    struct SceneOrder {
        topics::Command command;
        std::string file;
    };
    // The order is whoever's takes it; there is none other until it is answered.
    std::optional<SceneOrder> takeOrder() {
        const std::lock_guard lock(mutex_);
        return std::exchange(order_, std::nullopt);
    }
    void answerOrder(const topics::Command& command, const Answer& answer) {
        const std::lock_guard lock(mutex_);
        lesson_.clear_changing_to();
        has_changed_ = true;
        answers_.emplace_back(command, answer);
    }
    // A command that the scene that has ended can no longer answer.
    void answerLater(const topics::Command& command, const Answer& answer) {
        const std::lock_guard lock(mutex_);
        answers_.emplace_back(command, answer);
    }
    std::vector<std::pair<topics::Command, Answer>> takeAnswers() {
        const std::lock_guard lock(mutex_);
        for (const TableWriter::Written& written : table_.takeWritten()) {
            if (written.order)
                answers_.emplace_back(*written.order, answerTo(*written.order, written.problem));
            if (written.verdict) takeVerdict(written.attempt, *written.verdict);
        }
        return std::exchange(answers_, {});
    }

    // Says why the name cannot be a trainee's, or "".
    // What Protobuf has parsed is UTF-8.
    static std::string traineeProblem(const std::string& trainee) {
        if (trainee.find_first_not_of(' ') == std::string::npos) return "give the trainee's name or number";
        if (trainee.size() > kLongestTrainee)
            return "the trainee's name has " + std::to_string(trainee.size()) + " bytes; " +
                   std::to_string(kLongestTrainee) + " at most";
        if (hasUnprintable(trainee))
            return "the name '" + repeatedText(trainee) + "' has characters that cannot be printed";
        return "";
    }
    void beginAttempt(const std::string& trainee) {
        const std::lock_guard lock(mutex_);
        ++attempts_begun_;
        lesson_.set_is_running(true);
        lesson_.set_trainee(trainee);
        lesson_.set_start_stamp_ns(nowUnixNs());
        has_changed_ = true;
    }
    bool isAttemptRunning() const {
        const std::lock_guard lock(mutex_);
        return lesson_.is_running();
    }
    // How many attempts this trainee has had at the scene in force, the one under way included; of those that
    // the book still holds.
    int attemptsOf(const std::string& trainee) const {
        const std::lock_guard lock(mutex_);
        const auto is_one = [&](const topics::Attempt& attempt) {
            return attempt.trainee() == trainee && attempt.scene_id() == lesson_.scene_id();
        };
        return int(std::ranges::count_if(lesson_.attempts(), is_one)) +
               (lesson_.is_running() && lesson_.trainee() == trainee ? 1 : 0);
    }
    // The attempt under way ends as if it had never begun.
    void dropAttempt() {
        const std::lock_guard lock(mutex_);
        --attempts_begun_;
        lesson_.set_is_running(false);
        has_changed_ = true;
    }
    // In an examination viewers are told no figures of an attempt.
    enum class Told { kAll, kOnlyThatItWas };
    // Takes the attempt's figures; name, number, scene and start are filled in. It goes into the class table;
    // `order` is answered with takeAnswers() when it is there, or with what kept it from there. Where there
    // is a class table the attempt is judged, and its verdict shown when it is known.
    void endAttempt(topics::Attempt attempt, const std::optional<topics::Command>& order = {},
                    std::optional<AttemptJudgement> judgement = std::nullopt, Told told = Told::kAll) {
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

  private:
    static Answer answerTo(const topics::Command& order, const std::string& problem) {
        if (problem.empty()) return Answer::done();
        const bool is_of_another = order.action_case() == topics::Command::kStartAttempt;
        return Answer::failed(std::string(is_of_another ? "the attempt before" : "it") +
                              " is not in the class table: " + problem);
    }
    static int64_t nowUnixNs() {
        const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
        return std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
    }
    static topics::Attempt onlyThatItWas(const topics::Attempt& attempt) {
        topics::Attempt told;
        told.set_number(attempt.number());
        told.set_trainee(attempt.trainee());
        told.set_scene_id(attempt.scene_id());
        told.set_start_stamp_ns(attempt.start_stamp_ns());
        told.set_time_s(attempt.time_s());
        told.set_is_exam(true);
        return told;
    }

    void takeVerdict(uint32_t attempt, const topics::Verdict& verdict) {
        for (topics::Attempt& kept : *lesson_.mutable_attempts())
            if (kept.number() == attempt) *kept.mutable_verdict() = verdict;
        has_changed_ = true;
    }

    mutable std::mutex mutex_;
    const std::vector<ListedScene> scenes_;
    TableWriter table_;
    topics::Lesson lesson_;
    bool has_changed_ = true;
    uint32_t attempts_begun_ = 0;
    std::optional<SceneOrder> order_;  // not yet taken
    std::vector<std::pair<topics::Command, Answer>> answers_;
};

}  // namespace bonemill
