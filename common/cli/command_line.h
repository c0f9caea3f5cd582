// What the command lines of all programs share.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace bonemill {

// Adds --version. Returns false when only the help or the version was wanted; it is printed then. Throws
// UserError, which names `program`.
bool parseCommandLine(CLI::App& app, int argc, const char* const* argv, const std::string& program);

void addLogLevelOption(CLI::App& app, std::string& log_level);

// For a program with a real-time loop. `loop` is what the loop is called after "Processor core for"; -1 is
// any core.
void addRealtimeOptions(CLI::App& app, const std::string& loop, bool& is_strict, int& core);

// For a program that another one of ours starts for itself (common/process/end_with_parent.h).
void addParentOption(CLI::App& app, std::optional<int>& parent);

}  // namespace bonemill
