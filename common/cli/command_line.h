// What the command lines of all programs share.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace bonemill {

inline constexpr double kMaxSeconds = 1e7;  // 115 days, which still fits into 64 bits of nanoseconds

// Checks the bounds of a number. CLI::Range and CLI::PositiveNumber would let NaN pass.
inline CLI::Validator within(double low, double high) {
    return {[=](std::string& text) -> std::string {
                double value = 0;
                if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
                return text + " is not a number from " + CLI::detail::to_string(low) + " to " +
                       CLI::detail::to_string(high);
            },
            "NUMBER"};
}

// Adds --version. Returns false when only the help or the version was wanted; it is printed then. Throws
// UserError, which names `program`.
bool parseCommandLine(CLI::App& app, int argc, const char* const* argv, const std::string& program);

void addLogLevelOption(CLI::App& app, std::string& log_level);

// For a program with a real-time loop. `loop` is what the loop is called after "Processor core for"; -1 is
// any core.
void addRealtimeOptions(CLI::App& app, const std::string& loop, bool& is_strict, int& core);

// For a program that another one of ours starts for itself (common/process/run_program.h).
void addParentOption(CLI::App& app, std::optional<int>& parent);

}  // namespace bonemill
