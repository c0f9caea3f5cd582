// A class' attempts as a CSV file that a spreadsheet opens: one line per attempt that has ended, written at
// once, after its results and report, which lie beside it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/teaching/attempt_report/html_report.h"
#include "proto/topics.pb.h"

namespace bonemill {

// What an ended attempt still needs before it is in the class table: its judgement, which takes a second or
// two, and its files in the folder of the table. It is made by the publisher thread and carried out by the
// table's writer.
struct JudgedAttempt {
    Assessment assessment;
    std::vector<ReportPicture> pictures;
};

struct AttemptJudgement {
    // May wait; throws what kept it from judging. It needs nothing that ends with the scene.
    std::function<JudgedAttempt()> judge;
    uint64_t scene_hash = 0;  // sceneHashOf()
    double begin_s = 0;       // of the session
    std::string journal;      // the recording's file name; empty: none
    // Returns the recording's link that covers the attempt (newest_link.h); may wait. Empty: there is none.
    std::function<std::string()> link;
    bool is_exam = false;
    bool is_told = true;  // trainees may learn how it went
};

// It belongs to one normal thread. Lines are whole or not there, whatever happens; a file that is there
// already is only added to, with the columns that it has.
class ClassTable {
  public:
    // Nothing is written with an empty path. Throws UserError if the file cannot be written, or is something
    // else than a class table.
    explicit ClassTable(std::string path);

    bool hasFile() const noexcept { return !path_.empty(); }
    const std::string& path() const noexcept { return path_; }
    // Returns why the line is not there (disk full, among others), or "".
    std::string append(const topics::Attempt& attempt, const std::string& scene,
                       const std::string& chain = {}) const;

    // Tells whether a class table lies there. Throws UserError if that cannot be read, or another program
    // keeps it locked.
    static bool isTable(const std::string& path);
    // Takes all lines of this trainee out of it, and returns how many. Throws UserError.
    static size_t forget(const std::string& path, const std::string& trainee);

  private:
    std::string path_;
};

// Writes a class' attempts into its table on a thread of its own: a disk or a network folder that hangs keeps
// no other caller waiting.
class TableWriter {
  public:
    static constexpr size_t kMostWaiting = 64;  // lines

    explicit TableWriter(ClassTable table);
    // Waits for what is to be written, kLongestEnd_s at most, and says in the log what is not.
    ~TableWriter();
    TableWriter(TableWriter&&) noexcept = default;
    TableWriter& operator=(TableWriter&&) = delete;

    static constexpr int kLongestEnd_s = 5;

    // Any thread, at once. False: the queue is full and this line is left out. `scene` is the
    // scene's title; `order` is the one that waits for the line, if there is one. The attempt is judged
    // first, if it is to be: its files come before its line, which is there without them, too.
    bool write(const topics::Attempt& attempt, const std::string& scene,
               const std::optional<topics::Command>& order,
               std::optional<AttemptJudgement> judgement = std::nullopt);
    struct Written {
        std::optional<topics::Command> order;
        uint32_t attempt;                        // its number
        std::optional<topics::Verdict> verdict;  // what may be told of it
        std::string problem;                     // why the line, or the files, are not there, or ""
    };
    // Any thread: what was written since the last call.
    std::vector<Written> takeWritten();

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;  // with the thread, which may outlive this object
};

}  // namespace bonemill
