#include "haptic_server/teaching/lessons/table_writer.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

namespace bonemill {

struct TableWriter::Shared {
    struct Line {
        topics::Attempt attempt;
        std::string scene;
        std::optional<topics::Command> order;
        std::optional<AttemptJudgement> judgement;
    };
    Written write(const Line& line);
    explicit Shared(ClassTable of) : table(std::move(of)) {}
    void work();

    ClassTable table;  // the thread's
    std::mutex mutex;  // guards what is below
    std::condition_variable has_changed;
    std::deque<Line> waiting;  // the first one is being written
    std::vector<Written> written;
    bool is_ending = false;
};

TableWriter::Written TableWriter::Shared::write(const Line& line) {
    topics::Attempt attempt = line.attempt;
    std::string files_problem;
    if (line.judgement) files_problem = writeResults(*line.judgement, table.path(), line.scene, attempt);
    if (!files_problem.empty())
        spdlog::error("the results of attempt {} are not there: {}", attempt.number(), files_problem);
    std::string problem = table.append(attempt, line.scene);
    if (!problem.empty())
        spdlog::error("attempt {} is not in the class table: {}", attempt.number(), problem);
    Written written{line.order, attempt.number(), {}, problem.empty() ? files_problem : problem};
    if (attempt.has_verdict() && line.judgement->is_told) written.verdict = attempt.verdict();
    return written;
}

void TableWriter::Shared::work() {
    std::unique_lock lock(mutex);
    for (;;) {
        has_changed.wait(lock, [this] { return is_ending || !waiting.empty(); });
        if (waiting.empty()) return;
        const Line line = waiting.front();
        lock.unlock();
        Written result = write(line);
        lock.lock();
        waiting.pop_front();
        written.push_back(std::move(result));
        has_changed.notify_all();
    }
}

TableWriter::TableWriter(ClassTable table) : shared_(std::make_shared<Shared>(std::move(table))) {
    if (shared_->table.hasFile()) std::thread([shared = shared_] { shared->work(); }).detach();
}

TableWriter::~TableWriter() {
    if (!shared_) return;
    std::unique_lock lock(shared_->mutex);
    shared_->is_ending = true;
    shared_->has_changed.notify_all();
    shared_->has_changed.wait_for(lock, std::chrono::seconds(kLongestEnd_s),
                                  [this] { return shared_->waiting.empty(); });
    for (const Shared::Line& line : shared_->waiting)
        spdlog::error("attempt {} may not be in the class table: its disk hangs", line.attempt.number());
}

bool TableWriter::write(const topics::Attempt& attempt, const std::string& scene,
                        const std::optional<topics::Command>& order,
                        std::optional<AttemptJudgement> judgement) {
    const std::lock_guard lock(shared_->mutex);
    if (!shared_->table.hasFile()) {
        if (order) shared_->written.push_back({order, attempt.number(), {}, ""});
        return true;
    }
    if (shared_->waiting.size() >= kMostWaiting) return false;
    shared_->waiting.push_back({attempt, scene, order, std::move(judgement)});
    shared_->has_changed.notify_all();
    return true;
}

std::vector<TableWriter::Written> TableWriter::takeWritten() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->written, {});
}

}  // namespace bonemill
