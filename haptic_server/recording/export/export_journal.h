// `bonemill_lab session export`: a recorded session as files for other programs. What its ticks came to is
// had by running them again (docs/howto/replay.md).
#pragma once

#include <string>

namespace bonemill {

struct ExportOptions {
    std::string journal;
    // Files to write; empty: none.
    std::string h5;
    std::string csv;          // as --trace of a session
    std::string traj;         // what went in, for `simulate`
    std::string tool_path{};  // the tool's way in an attempt, for a scene's expert_path
    int attempt = 0;          // of that one, from 1; 0: the last
    std::string foxglove{};   // .mcap, and beside it its layout
    // What another program recorded at the same time, to be brought onto the session's clock (align_file.h).
    std::string align{};
    std::string aligned{};      // where that goes; empty: beside it
    std::string align_clock{};  // the column with its own time; empty: the first one
};

// Each file is whole or not there. Throws UserError: no journal, nothing to write, a file that cannot be
// written.
void exportJournal(const ExportOptions& options);

}  // namespace bonemill
