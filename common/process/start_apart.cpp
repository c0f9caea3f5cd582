#include "common/process/start_apart.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "common/process/child_start.h"

namespace bonemill {
namespace {

// Tells whoever reads the pipe, and ends.
[[noreturn]] void giveUp(int pipe) {
    const char sign = 1;
    _exit(write(pipe, &sign, 1) == 1 ? 1 : 2);
}

}  // namespace

// The child's child is nobody's to wait for, and holds nothing of ours: not even the output, which somebody
// may read to its end. A pipe that exec closes tells whether there was a program.
bool startApart(const std::vector<std::string>& words) {
    std::vector<char*> arguments = argumentsOf(words);
    int failed[2];
    if (pipe2(failed, O_CLOEXEC) != 0) return false;
    const pid_t child = fork();
    if (child == 0) {
        const pid_t own = setsid() < 0 ? -1 : fork();
        if (own > 0) _exit(0);
        if (own < 0) giveUp(failed[1]);
        const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
        dup2(nothing, STDIN_FILENO);
        dup2(nothing, STDOUT_FILENO);
        becomeProgram(arguments);
        giveUp(failed[1]);
    }
    close(failed[1]);
    char sign = 0;
    ssize_t got = -1;
    if (child > 0) {
        waitpid(child, nullptr, 0);
        while ((got = read(failed[0], &sign, 1)) < 0 && errno == EINTR) {
        }
    }
    close(failed[0]);
    return got == 0;
}

}  // namespace bonemill
