// All that the window to begin in knows: what bonemill says, what was chosen, and the command that runs.
//
// It asks bonemill beside the window, and starts bonemill's own commands; poll() takes what has come of it.
// It belongs to the thread of the window.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/process/child_beside.h"
#include "render_client/hand/controls/past_attempts.h"
#include "render_client/start_window/start_desk/launcher_facts.h"
#include "render_client/start_window/start_desk/launcher_words.h"

namespace bonemill {

// A question to bonemill, which is asked again and again.
class RepeatedQuestion {
  public:
    using Clock = std::chrono::steady_clock;
    RepeatedQuestion(std::vector<std::string> words, Clock::duration every)
        : words_(std::move(words)), every_(every) {}

    // Asks when it is time, and returns the answer when it has come: once.
    std::optional<std::string> poll();
    // Why the last answer is none; empty: it is one.
    const std::string& problem() const { return problem_; }
    void askNow() { due_ = {}; }
    void drop() { child_.reset(); }

  private:
    std::vector<std::string> words_;
    Clock::duration every_;
    Clock::time_point due_{};
    std::unique_ptr<ChildBeside> child_;
    std::string problem_;
};

class StartDesk {
  public:
    // `launcher` is bonemill's own script, `network` the options that all commands are given.
    StartDesk(const std::string& launcher, std::vector<std::string> network);

    // Takes what is done. While a session of ours is on the screen nothing is asked.
    void poll();

    const ListFacts& list() const { return list_; }
    const std::vector<PastAttempt>& attempts() const { return attempts_; }
    const std::vector<FoundSession>& found() const { return found_; }
    // Nothing: the doctor has not come yet.
    const std::optional<DoctorFacts>& doctor() const { return doctor_; }
    bool hasList() const { return has_list_; }

    StartChoice& choice() { return choice_; }
    const StartChoice& choice() const { return choice_; }

    // Each starts one command; one at a time: while one runs, nothing happens.
    void start(const SceneCard& card);
    void replay(const std::string& file);
    void watch(const FoundSession& session);
    void watchOwn(const RunningSession& session);
    void watchHost(const std::string& host);
    // Go on beside the window, each in one of its own.
    void makeCase();
    void openHandbook();
    void openReport(const PastAttempt& attempt);
    void endOwn(const RunningSession& session);

    // What was started runs. Its last words; and whether its own window is there, so that this one may go.
    bool isBusy() const { return session_ != nullptr; }
    bool hasWindowOfItsOwn() const { return has_window_; }
    const std::string& commandLine() const { return command_line_; }
    std::string lastWords() const;
    void askToEnd() const;
    // Why the last one ended early; empty: it did not.
    const std::string& problem() const { return problem_; }
    void forgetProblem() { problem_.clear(); }

  private:
    void run(const std::vector<std::string>& words);
    void apart(const std::vector<std::string>& words);
    void followSession();
    void followErrand();
    std::vector<std::string> asked(std::vector<std::string> words, bool has_network) const;

    std::string launcher_;
    std::vector<std::string> network_;
    RepeatedQuestion list_question_, attempts_question_, found_question_, doctor_question_;
    ListFacts list_;
    bool has_list_ = false;
    std::vector<PastAttempt> attempts_;
    std::vector<FoundSession> found_;
    std::optional<DoctorFacts> doctor_;
    StartChoice choice_;
    std::unique_ptr<ChildBeside> session_, errand_;
    std::string command_line_, problem_;
    bool has_window_ = false;
};

// The line that says why a command failed: the first that it printed as an error, without its own name.
std::string firstErrorOf(const ChildBeside& child);

}  // namespace bonemill
