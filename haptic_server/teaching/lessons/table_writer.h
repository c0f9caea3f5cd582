// Writes a class' attempts into its table on a thread of its own: a disk or a network folder that hangs keeps
// no other caller waiting.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/teaching/lessons/attempt_results.h"
#include "haptic_server/teaching/lessons/class_table.h"

namespace bonemill {

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
