// Finds and reads the attempt that a replay is to be compared with. Normal threads; it waits for the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

struct AttemptName {
    // A recording (.mcap), or an attempt's result (.json), which says what recording it is in.
    std::filesystem::path file;
    uint32_t number = 0;  // of a recording's attempts, from 1; 0: the last one
};

// Where the user's attempts are; empty: not known.
struct AttemptFolders {
    std::filesystem::path classes;     // one folder each, with `results` and `experts`
    std::filesystem::path recordings;  // of all classes
};

struct ComparedAttempt {
    std::unique_ptr<const Recording> recording;
    RecordedAttempt attempt;  // the whole session where it has none
    std::string text;         // whose it is and when it was, for people
};

// The result of this name, without folder and ending, in any class. Throws UserError if there is none.
std::filesystem::path resultOfName(const AttemptFolders& folders, const std::string& name);

// Throws UserError if it cannot be read, has no such attempt, or is of another scene, or another scan, than
// the recording that is shown.
ComparedAttempt openCompared(const AttemptName& name, const AttemptFolders& folders, const Recording& shown);

}  // namespace bonemill
