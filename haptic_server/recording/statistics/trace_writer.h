// Writes one CSV line per tick: the same file from a live session and from `simulate`, so that plots
// and checks compare.
//
// The columns are those of tick_columns.h that have names in traces. Numbers round-trip, masks are decimal
// numbers. It belongs to one normal thread.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "haptic_server/recording/statistics/tick_columns.h"

namespace bonemill {

class TraceWriter {
  public:
    // Creates or empties the file and writes the header. Throws UserError when it cannot be written.
    explicit TraceWriter(const std::string& path, const RecordedEffects& recorded = {});

    // It is false from then on once the file could not be written (disk full): the session goes
    // on without it.
    bool write(const TickRecord& record);

    // Flushes and closes; false if anything was lost. Without it the destructor closes silently.
    bool close();

  private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };

    std::vector<TickColumn> columns_;
    std::unique_ptr<std::FILE, Close> file_;
    std::string line_;
    bool is_good_ = true;
};

}  // namespace bonemill
