// `bonemill_lab session what-if`: from a moment on a recorded session goes on otherwise, and is judged beside
// what happened. One normal thread; it waits for the disk.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace bonemill {

struct WhatIfOptions {
    std::filesystem::path journal;
    double at_s = 0;               // of the session's clock
    std::string tool, accuracy;    // name, or of a tool its number from 1; empty: as it was
    std::vector<double> shift_mm;  // of the hand, W; empty: none
    double pace = 1;               // of the hand
    bool is_experts = false;       // the hand is the expert's of the scene's task
    std::filesystem::path
        out;  // the other recording (.mcap); beside it go the page (.html) and the figures (.json)
    std::string version;  // what --version prints
};

// Writes the three files and says on `said` what came out. Throws UserError if the recording cannot be run
// again, or cannot go on so, and if one of them is there already.
void whatIf(const WhatIfOptions& options, std::ostream& said);

}  // namespace bonemill
