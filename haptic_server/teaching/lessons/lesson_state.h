// What the server can teach, teaches, and how attempts went: it lives as long as the process, and scenes come
// and go.
//
// Any normal thread may call it. It takes a mutex, so it is not for the tick.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/commands/answer.h"
#include "haptic_server/teaching/lessons/class_table.h"
#include "haptic_server/teaching/lessons/scene_folder.h"
#include "proto/topics.pb.h"

namespace bonemill {

class LessonState {
  public:
    static constexpr int kMaxAttempts = 256;
    static constexpr size_t kLongestTrainee = 48;  // bytes

    LessonState(std::vector<ListedScene> scenes, ClassTable table);

    // The publisher thread asks what is to be shown, once per change; the epoch is still missing, and so are
    // the pictures of the scenes, which never change.
    std::optional<topics::Lesson> takeChanged();
    const std::vector<ListedScene>& scenes() const noexcept { return scenes_; }
    // The scene of this file is in force now: it is told anew.
    void enterScene(const std::string& file);

    // A client asks for another scene. The answer is the refusal, or nothing: then it comes with
    // takeAnswers().
    std::optional<Answer> orderScene(const topics::Command& command);
    struct SceneOrder {
        topics::Command command;
        std::string file;
    };
    // The order is whoever's takes it; there is none other until it is answered.
    std::optional<SceneOrder> takeOrder();
    void answerOrder(const topics::Command& command, const Answer& answer);
    // A command that the scene that has ended can no longer answer.
    void answerLater(const topics::Command& command, const Answer& answer);
    std::vector<std::pair<topics::Command, Answer>> takeAnswers();

    // Says why the name cannot be a trainee's, or "".
    static std::string traineeProblem(const std::string& trainee);
    void beginAttempt(const std::string& trainee);
    bool isAttemptRunning() const;
    // How many attempts this trainee has had at the scene in force, the one under way included; of those that
    // the book still holds.
    int attemptsOf(const std::string& trainee) const;
    // The attempt under way ends as if it had never begun.
    void dropAttempt();
    // In an examination viewers are told no figures of an attempt.
    enum class Told { kAll, kOnlyThatItWas };
    // Takes the attempt's figures; name, number, scene and start are filled in. It goes into the class table;
    // `order` is answered with takeAnswers() when it is there, or with what kept it from there. Where there
    // is a class table the attempt is judged, and its verdict shown when it is known.
    void endAttempt(topics::Attempt attempt, const std::optional<topics::Command>& order = {},
                    std::optional<AttemptJudgement> judgement = std::nullopt, Told told = Told::kAll);

  private:
    void takeVerdict(uint32_t attempt, const topics::Verdict& verdict);

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
