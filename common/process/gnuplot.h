// Draws by gnuplot, a child process that is waited for. Not for a real-time thread.
#pragma once

#include <filesystem>

namespace bonemill {

// Runs it on a script file, in the script's folder. Throws UserError if there is no gnuplot or it fails.
void runGnuplot(const std::filesystem::path& script);

}  // namespace bonemill
