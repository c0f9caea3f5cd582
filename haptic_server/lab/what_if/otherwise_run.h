// Runs a recording again up to a moment, then otherwise, and records it as a session of its own. One normal
// thread; it waits for the disk.
#pragma once

#include <filesystem>
#include <string>

#include "haptic_server/lab/what_if/other_hand.h"

namespace bonemill {

struct OtherwiseRun {
    Otherwise otherwise;
    RecordedAttempt attempt;  // in which the moment lies, or the whole session
    uint64_t first = 0;       // tick
    std::string change;       // what is otherwise, for people
    std::string version;      // what --version prints
};

// Writes the journal, which ends with the attempt. Returns that attempt as the journal has it. Throws
// UserError.
RecordedAttempt recordOtherwise(const Recording& recording, const OtherwiseRun& run,
                                const std::filesystem::path& journal);

// So many ticks before `first` came to what they came to in the session: all of them, where both are of one
// build.
uint64_t sameTicks(const Recording& happened, const Recording& otherwise, uint64_t first);

}  // namespace bonemill
