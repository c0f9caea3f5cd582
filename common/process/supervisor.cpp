#include "common/process/supervisor.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <optional>
#include <system_error>
#include <thread>

#include "common/process/run_program.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRestsToLast = 10;

struct Child {
    pid_t pid = 0;  // 0: this is the child itself
    int pipe = -1;  // the end that is this process'
};

Child begin() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    const pid_t parent = getpid(), pid = fork();
    if (pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
    close(ends[pid == 0 ? 0 : 1]);
    if (pid == 0) endWithParent(parent);
    return {pid, ends[pid == 0 ? 1 : 0]};
}

// Returns whether the work has come round since, after one round of waiting at most.
bool hearsBeat(int pipe, std::chrono::milliseconds round) {
    pollfd look{pipe, POLLIN, 0};
    if (poll(&look, 1, int(round.count())) <= 0 || (look.revents & POLLIN) == 0) {
        if (look.revents != 0) std::this_thread::sleep_for(round);  // the work has closed its end
        return false;
    }
    for (char bytes[256]; read(pipe, bytes, sizeof bytes) > 0;) {
    }
    return true;
}

std::optional<int> statusOf(pid_t pid) {
    int status = 0;
    return waitpid(pid, &status, WNOHANG) == pid ? std::optional(status) : std::nullopt;
}

int killNow(pid_t pid) {
    int status = 0;
    kill(pid, SIGKILL);
    waitpid(pid, &status, 0);
    return status;
}

int exitCodeOf(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string endOf(int status) {
    return WIFEXITED(status) ? "with exit code " + std::to_string(WEXITSTATUS(status))
                             : "by signal " + std::to_string(WTERMSIG(status));
}

int endInOrder(const std::string& what, pid_t pid, const SupervisorTimes& times) {
    kill(pid, SIGTERM);
    const auto end = Clock::now() + times.to_end;
    constexpr std::chrono::milliseconds kLook{10};
    for (; Clock::now() < end; std::this_thread::sleep_for(kLook))
        if (const auto status = statusOf(pid)) return exitCodeOf(*status);
    spdlog::error("{} does not end when asked to: it is killed", what);
    return exitCodeOf(killNow(pid));
}

// Returns an exit code, or nothing: the work is to be started again.
std::optional<int> watch(const std::string& what, const Child& child,
                         const std::function<bool()>& should_stop, const SupervisorTimes& times) {
    bool has_beaten = false;
    // Rounds, not time: where this PC gives no process its turn, that is not the work's fault.
    for (int silent_rounds = 0;;) {
        if (should_stop()) return endInOrder(what, child.pid, times);
        const bool beats = hearsBeat(child.pipe, times.round);
        has_beaten = has_beaten || beats;
        silent_rounds = beats ? 0 : silent_rounds + 1;
        if (const auto status = statusOf(child.pid)) {
            if (!has_beaten || should_stop() || *status == 0) return exitCodeOf(*status);
            spdlog::error("{} has ended {}: it is started again", what, endOf(*status));
            return std::nullopt;
        }
        if (silent_rounds < (has_beaten ? times.most_silent_rounds : times.most_starting_rounds)) continue;
        spdlog::error("{} has not come round for {:.1f} s: it is ended and started again", what,
                      std::chrono::duration<double>(silent_rounds * times.round).count());
        killNow(child.pid);
        return std::nullopt;
    }
}

}  // namespace

void Heartbeat::beat() const noexcept {
    // A full pipe says it as well.
    [[maybe_unused]] const ssize_t written = write(pipe_, "", 1);
}

int supervise(const std::string& what, const std::function<bool()>& should_stop,
              const std::function<int(const Heartbeat&, bool)>& work, const SupervisorTimes& times) {
    for (bool is_first = true;; is_first = false) {
        const auto began = Clock::now();
        const Child child = begin();
        if (child.pid == 0) return work(Heartbeat(child.pipe), is_first);
        const std::optional<int> code = watch(what, child, should_stop, times);
        close(child.pipe);
        if (code) return *code;
        if (Clock::now() - began < kRestsToLast * times.to_rest) std::this_thread::sleep_for(times.to_rest);
    }
}

}  // namespace bonemill
