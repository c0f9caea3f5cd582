#include "common/process/gnuplot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr int kCommandNotFound = 127;
constexpr char kWithout[] = "; the picture is missing, the figures are written";
constexpr char kRemedy[] = " (Debian: apt install gnuplot-nox)";

// Returns an error's number, or 0.
int spawnIn(const std::filesystem::path& folder, std::string program, std::string argument, pid_t& child) {
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    const int error = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

}  // namespace

void runGnuplot(const std::filesystem::path& script) {
    pid_t child = 0;
    if (const int error = spawnIn(script.parent_path(), "gnuplot", script.filename().string(), child))
        throw UserError(std::string("gnuplot cannot be run (") + std::strerror(error) + ')' + kWithout +
                        kRemedy);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kCommandNotFound)
        throw UserError(std::string("gnuplot cannot be run") + kWithout + kRemedy);
    throw UserError("gnuplot failed on " + script.string() + kWithout);
}

}  // namespace bonemill
