#include "render_client/start_window/start_desk/start_desk.h"

#include <system_error>
#include <utility>

#include "common/process/start_apart.h"
#include "common/text/foreign_text.h"
#include "render_client/language/language.h"

namespace bonemill {
namespace {

constexpr std::chrono::seconds kListEvery{10}, kFoundEvery{15}, kDoctorEvery{120};
// By this bonemill says that a session's window is coming.
constexpr char kWindowComes[] = "close the window";
constexpr char kOwnName[] = "bonemill: ";

std::string withoutName(const std::string& line) {
    return line.starts_with(kOwnName) ? line.substr(sizeof kOwnName - 1) : line;
}

std::string lastLineOf(std::string text) {
    while (text.ends_with('\n')) text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

}  // namespace

std::optional<std::string> RepeatedQuestion::poll() {
    if (!child_) {
        if (Clock::now() < due_) return std::nullopt;
        due_ = Clock::now() + every_;
        try {
            child_ = std::make_unique<ChildBeside>(words_);
        } catch (const std::system_error&) {  // the next time is soon enough
        }
        return std::nullopt;
    }
    child_->poll();
    if (!child_->exitCode()) return std::nullopt;
    due_ = Clock::now() + every_;
    problem_ = *child_->exitCode() == 0 ? "" : firstErrorOf(*child_);
    return std::exchange(child_, nullptr)->out();
}

StartDesk::StartDesk(const std::string& launcher, std::vector<std::string> network)
    : launcher_(launcher),
      network_(std::move(network)),
      list_question_(asked({"list", "--tab-separated"}, false), kListEvery),
      attempts_question_(asked({"sessions", "--tab-separated"}, false), kListEvery),
      found_question_(asked({"watch", "--list", "--tab-separated"}, true), kFoundEvery),
      doctor_question_(asked({"doctor", "--tab-separated"}, false), kDoctorEvery) {}

std::vector<std::string> StartDesk::asked(std::vector<std::string> words, bool has_network) const {
    words.insert(words.begin(), launcher_);
    if (has_network) words.insert(words.end(), network_.begin(), network_.end());
    return words;
}

void StartDesk::poll() {
    followErrand();
    if (session_) {
        followSession();
        return;
    }
    if (const auto lines = list_question_.poll()) {
        list_ = listFactsOf(*lines);
        has_list_ = true;
        if (!list_question_.problem().empty()) problem_ = list_question_.problem();
    }
    if (!has_list_) return;  // the cards come first
    if (const auto lines = attempts_question_.poll()) attempts_ = pastAttemptsOf(*lines);
    if (const auto lines = doctor_question_.poll()) doctor_ = doctorFactsOf(*lines);
    if (!doctor_) return;
    if (const auto lines = found_question_.poll()) found_ = foundSessionsOf(*lines);
}

void StartDesk::followSession() {
    session_->poll();
    has_window_ = has_window_ || session_->out().find(kWindowComes) != std::string::npos;
    if (!session_->exitCode()) return;
    if (*session_->exitCode() != 0) problem_ = firstErrorOf(*session_);
    session_.reset();
    has_window_ = false;
    list_question_.askNow();
    attempts_question_.askNow();
}

void StartDesk::followErrand() {
    if (!errand_) return;
    errand_->poll();
    if (!errand_->exitCode()) return;
    if (*errand_->exitCode() != 0) problem_ = firstErrorOf(*errand_);
    errand_.reset();
    list_question_.askNow();
}

// What is asked meanwhile would take time from the session.
void StartDesk::run(const std::vector<std::string>& words) {
    if (session_) return;
    problem_.clear();
    command_line_ = commandLineOf(words);
    for (RepeatedQuestion* const question :
         {&list_question_, &attempts_question_, &found_question_, &doctor_question_})
        question->drop();
    try {
        session_ = std::make_unique<ChildBeside>(asked(words, false));
    } catch (const std::system_error& error) {
        problem_ = error.what();
    }
}

void StartDesk::apart(const std::vector<std::string>& words) {
    if (!startApart(words)) problem_ = tr("{1} cannot be started", {words.front()});
}

void StartDesk::start(const SceneCard& card) {
    run(startWords(card, choice_, network_));
}

void StartDesk::replay(const std::string& file) {
    run(replayWords(file, network_));
}

void StartDesk::watch(const FoundSession& session) {
    run(watchWords(session, network_));
}

void StartDesk::watchOwn(const RunningSession& session) {
    run(watchOwnWords(session));
}

void StartDesk::watchHost(const std::string& host) {
    run(watchHostWords(host, network_));
}

void StartDesk::makeCase() {
    apart({launcher_, "scan"});
}

void StartDesk::openReport(const PastAttempt& attempt) {
    apart({"xdg-open", attempt.stem + ".html"});
}

// These say what is wrong, if anything is.
void StartDesk::openHandbook() {
    errand_ = std::make_unique<ChildBeside>(asked({"handbook"}, false));
}

void StartDesk::endOwn(const RunningSession& session) {
    errand_ = std::make_unique<ChildBeside>(asked({"stop", session.number}, false));
}

std::string StartDesk::lastWords() const {
    return session_ ? printableLine(withoutName(lastLineOf(session_->out()))) : "";
}

void StartDesk::askToEnd() const {
    if (session_) session_->askToEnd();
}

std::string firstErrorOf(const ChildBeside& child) {
    const std::string line = child.err().substr(0, child.err().find('\n'));
    if (!line.empty()) return printableLine(withoutName(line), 400);
    const int code = child.exitCode().value_or(0);
    return code > 128 ? tr("bonemill was ended by signal {1}", {std::to_string(code - 128)})
                      : tr("bonemill left with code {1}", {std::to_string(code)});
}

}  // namespace bonemill
