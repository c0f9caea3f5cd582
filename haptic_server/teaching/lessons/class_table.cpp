#include "haptic_server/teaching/lessons/class_table.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "common/attempts_csv/attempts_csv.h"
#include "common/files/line_file.h"
#include "common/text/hex_text.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"

namespace bonemill {
namespace {

void fillVerdict(const AttemptResult& result, topics::Verdict& verdict) {
    const Assessment& assessment = result.assessment;
    if (!assessment.gates.empty()) verdict.set_passed(assessment.hasPassed());
    for (const GateResult& gate : assessment.gates)
        if (!gate.is_passed) verdict.add_failed_gates(gate.label);
    if (assessment.total) verdict.set_score_percent(100 * assessment.total->score);
    verdict.set_results(fileStemOf(result));
}

constexpr size_t kLongestHeader = 4096;
constexpr size_t kMaxTable = size_t(64) << 20;

// 0: it is no class table.
size_t columnsIn(const LineFile& file) {
    const std::string start = file.read(0, kLongestHeader);
    return attemptColumns(start.substr(0, start.find('\n')));
}

// The columns of the table: those of today, or fewer of a table that an earlier release began.
size_t columnsOf(const LineFile& file, const std::string& path) {
    if (file.size() == 0) return attemptColumns(kAttemptsHeader);
    const size_t columns = columnsIn(file);
    if (columns == 0)
        throw UserError(path + ": is there and has other columns than a class table; name another file");
    return columns;
}

// Judges the attempt, writes results and report beside the class table, and fills in the attempt's verdict.
// `scene` is the scene's title. Returns why the files are not there, or "".
std::string writeResults(const AttemptJudgement& judgement, const std::string& class_table,
                         const std::string& scene, const std::string& chain, topics::Attempt& attempt) {
    try {
        JudgedAttempt judged = judgement.judge();
        AttemptResult result;
        result.pseudonym = attempt.trainee();
        result.number = attempt.number();
        result.scene_id = attempt.scene_id();
        result.scene_title = scene;
        result.scene_hash = hexText(judgement.scene_hash);
        result.start_unix_ns = attempt.start_stamp_ns();
        result.duration_s = attempt.time_s();
        result.journal = judgement.journal;
        result.chain = chain;
        result.is_exam = judgement.is_exam;
        result.assessment = std::move(judged.assessment);
        const ResultFolder folder(std::filesystem::absolute(class_table).parent_path());
        folder.write(result, std::move(judged.pictures), judgement.begin_s);
        fillVerdict(result, *attempt.mutable_verdict());
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace

ClassTable::ClassTable(std::string path) : path_(std::move(path)) {
    if (path_.empty()) return;
    try {
        if (!std::filesystem::exists(path_)) {
            requireWritable(path_);
            return;
        }
        columnsOf(LineFile(path_), path_);
    } catch (const UserError& error) {
        throw UserError(std::string("--class-table ") + error.what());
    }
}

std::string ClassTable::append(const topics::Attempt& attempt, const std::string& scene,
                               const std::string& chain) const {
    if (path_.empty()) return "";
    try {
        const LineFile file(path_);
        const size_t columns = columnsOf(file, path_);
        const std::string header = file.size() == 0 ? attemptsHeaderLine() : "";
        file.append(header + attemptLine(attempt, scene, chain, columns) + "\n");
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

size_t ClassTable::forget(const std::string& path, const std::string& trainee) {
    const LineFile file(path);
    columnsOf(file, path);
    if (file.size() > off_t(kMaxTable))
        throw UserError(path + ": is larger than any class table; delete the lines by hand");
    return file.removeLines(
        [&](const std::string& line, bool is_header) { return !is_header && isAttemptOf(line, trainee); });
}

bool ClassTable::isTable(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    return columnsIn(LineFile(path)) > 0;
}

struct TableWriter::Shared {
    struct Line {
        topics::Attempt attempt;
        std::string scene;
        std::optional<topics::Command> order;
        std::optional<AttemptJudgement> judgement;
    };
    explicit Shared(ClassTable of) : table(std::move(of)) {}
    Written write(const Line& line) {
        topics::Attempt attempt = line.attempt;
        std::string files_problem;
        const std::string chain = line.judgement && line.judgement->link ? line.judgement->link() : "";
        if (line.judgement)
            files_problem = writeResults(*line.judgement, table.path(), line.scene, chain, attempt);
        if (!files_problem.empty())
            spdlog::error("the results of attempt {} are not there: {}", attempt.number(), files_problem);
        std::string problem = table.append(attempt, line.scene, chain);
        if (!problem.empty())
            spdlog::error("attempt {} is not in the class table: {}", attempt.number(), problem);
        if (line.judgement && files_problem.empty()) writePage();
        Written written{line.order, attempt.number(), {}, problem.empty() ? files_problem : problem};
        if (attempt.has_verdict() && line.judgement->is_told) written.verdict = attempt.verdict();
        return written;
    }
    // It is made of what lies in the results; the table has the attempt already.
    void writePage() const {
        try {
            ResultFolder(std::filesystem::absolute(table.path()).parent_path()).writeClassPage();
        } catch (const std::exception& error) {
            spdlog::error("the class' page is not up to date: {}", error.what());
        }
    }
    void work() {
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

    ClassTable table;  // the thread's
    std::mutex mutex;  // guards what is below
    std::condition_variable has_changed;
    std::deque<Line> waiting;  // the first one is being written
    std::vector<Written> written;
    bool is_ending = false;
};

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
