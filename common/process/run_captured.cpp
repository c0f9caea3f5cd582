#include "common/process/run_captured.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "common/process/child_start.h"

namespace bonemill {
namespace {

constexpr int kNoProgram = 127;

// Reads what there is; false at the end.
bool readSome(int pipe, std::string& text) {
    std::array<char, 4096> bytes;
    const ssize_t got = read(pipe, bytes.data(), bytes.size());
    if (got <= 0) return got < 0 && errno == EINTR;
    text.append(bytes.data(), std::min(size_t(got), kMostCaptured - text.size()));
    return true;
}

void readBoth(int out, int err, Captured& captured) {
    std::array<pollfd, 2> pipes{{{out, POLLIN, 0}, {err, POLLIN, 0}}};
    while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
        if (poll(pipes.data(), pipes.size(), -1) < 0) {
            if (errno == EINTR) continue;
            return;
        }
        for (size_t n = 0; n < pipes.size(); ++n)
            if (pipes[n].revents != 0 && !readSome(pipes[n].fd, n == 0 ? captured.out : captured.err))
                pipes[n].fd = -1;
    }
}

}  // namespace

Captured runCaptured(const std::vector<std::string>& words) {
    const std::vector<char*> arguments = argumentsOf(words);
    int out[2], err[2];
    if (pipe2(out, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    if (pipe2(err, O_CLOEXEC) != 0) {
        close(out[0]);
        close(out[1]);
        throw std::system_error(EMFILE, std::generic_category(), "pipe");
    }
    const pid_t child = fork();
    if (child == 0) {
        dup2(out[1], STDOUT_FILENO);
        dup2(err[1], STDERR_FILENO);
        becomeProgram(arguments);
        _exit(kNoProgram);
    }
    close(out[1]);
    close(err[1]);
    Captured captured;
    if (child > 0) readBoth(out[0], err[0], captured);
    close(out[0]);
    close(err[0]);
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    captured.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return captured;
}

}  // namespace bonemill
