// `bonemill_lab session assess`: measures and judges the attempts of a recorded session anew, by running its
// ticks again: with today's definitions, and the task that the recorded scene has. Normal threads.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace bonemill {

struct AssessOptions {
    std::filesystem::path journal;
    std::string out;  // folder, as of a class table
};

// Writes results and report of every attempt and says on `said` which. Returns the exit code: 1 if a file is
// missing. Throws UserError if the journal is none, or holds no attempt.
int assessJournal(const AssessOptions& options, std::ostream& said);

}  // namespace bonemill
