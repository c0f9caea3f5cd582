#include "common/process/child_beside.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "common/process/child_start.h"
#include "common/process/run_captured.h"
#include "common/process/run_program.h"

namespace bonemill {
namespace {

constexpr int kNoSuchProgram = 127;

}  // namespace

// Whoever has been left by its children may hold the pipe open: what nobody writes to is not waited for.
void ChildBeside::Outlet::take() {
    std::array<char, 4096> bytes;
    while (pipe >= 0) {
        const ssize_t got = read(pipe, bytes.data(), bytes.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0 && errno == EAGAIN) return;
        if (got <= 0) {
            close(pipe);
            pipe = -1;
            return;
        }
        text.append(bytes.data(), std::min(size_t(got), kMostCaptured - text.size()));
    }
}

ChildBeside::ChildBeside(const std::vector<std::string>& words) {
    const std::vector<char*> arguments = argumentsOf(words);
    int out[2], err[2];
    if (pipe2(out, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    out_.pipe = out[0];
    if (pipe2(err, O_CLOEXEC | O_NONBLOCK) == 0) {
        err_.pipe = err[0];
        const pid_t parent = getpid();
        child_ = fork();
        if (child_ == 0) {
            setpgid(0, 0);
            endWithParent(parent);
            const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
            dup2(nothing, STDIN_FILENO);
            for (const auto& [pipe, stream] : {std::pair{out[1], STDOUT_FILENO}, {err[1], STDERR_FILENO}}) {
                fcntl(pipe, F_SETFL, 0);  // it may wait for us
                dup2(pipe, stream);
            }
            becomeProgram(arguments);
            _exit(kNoSuchProgram);
        }
        if (child_ > 0) setpgid(child_, child_);
        close(err[1]);
    }
    const int problem = errno;
    close(out[1]);
    if (child_ > 0) return;
    for (const Outlet& outlet : {out_, err_})
        if (outlet.pipe >= 0) close(outlet.pipe);
    throw std::system_error(problem, std::generic_category(), "fork");
}

ChildBeside::~ChildBeside() {
    askToEnd();
    for (const Outlet& outlet : {out_, err_})
        if (outlet.pipe >= 0) close(outlet.pipe);
    if (!exit_code_) waitpid(child_, nullptr, WNOHANG);
}

void ChildBeside::poll() {
    if (exit_code_) return;
    int status = 0;
    const bool has_ended = waitpid(child_, &status, WNOHANG) == child_;
    out_.take();
    err_.take();
    if (has_ended) exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void ChildBeside::askToEnd() const {
    if (!exit_code_) kill(-child_, SIGTERM);
}

}  // namespace bonemill
