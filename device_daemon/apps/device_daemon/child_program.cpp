#include "device_daemon/apps/device_daemon/child_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>

#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int64_t kStartNs = 10 * kNsPerSecond;  // a loaded machine reads a large scene in this time
constexpr int64_t kEndNs = 2 * kNsPerSecond;
constexpr int64_t kRestartNs = kNsPerSecond;

// A new process shares the daemon's memory until it has become `path`. With fork() the kernel would copy the
// page table of all that is locked, and the real-time thread beside would wait for it.
pid_t spawn(const char* path, char* const* words, int output) {
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    pid_t child = -1;
    if (posix_spawn(&child, path, &actions, &attributes, words, environ) != 0) child = -1;
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return child;
}

}  // namespace

std::string programPath(const std::string& name) {
    const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    for (const auto& folder : {here, here.parent_path()})
        if (access((folder / name).c_str(), X_OK) == 0) return folder / name;
    throw UserError(name + " is missing beside device_daemon in " + here.string() +
                    ": install it, or build it: cmake --build --preset release --target " + name);
}

ChildProgram::ChildProgram(const std::string& name, std::vector<std::string> words)
    : path_(programPath(name)), words_(std::move(words)) {
    start();
    if (pid_ < 0) throw UserError(path_ + " cannot be started");
    awaitPort();
}

ChildProgram::~ChildProgram() {
    finish();
}

void ChildProgram::start() {
    std::vector<std::string> words = words_;
    words.insert(words.begin(), path_);
    words.insert(words.end(),
                 {"--port", std::to_string(port_), "--end-with-parent", std::to_string(getpid())});
    std::vector<char*> raw;
    for (std::string& word : words) raw.push_back(word.data());
    raw.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw UserError("no pipe for " + path_);
    pid_ = spawn(path_.c_str(), raw.data(), ends[1]);
    close(ends[1]);
    if (output_ >= 0) close(output_);
    output_ = ends[0];
    fcntl(output_, F_SETFL, O_NONBLOCK);
    ended_ns_ = pid_ < 0 ? monotonicNowNs() : 0;
}

void ChildProgram::awaitPort() {
    constexpr std::string_view kSays = "listening on ";
    const int64_t deadline_ns = monotonicNowNs() + kStartNs;
    while (last_line_.rfind(kSays, 0) != 0) {
        if (hasEnded()) throw UserError(path_ + " ended at its start; its message is above");
        if (monotonicNowNs() > deadline_ns) throw UserError(path_ + " did not say at which port it listens");
        pollfd poll_output{.fd = output_, .events = POLLIN, .revents = 0};
        poll(&poll_output, 1, 50);
        takeWords();
    }
    const size_t colon = last_line_.rfind(':');
    const char* const digits = last_line_.data() + colon + 1;
    std::from_chars(digits, last_line_.data() + last_line_.size(), port_);
    if (colon == std::string::npos || port_ == 0) throw UserError(path_ + " said no port: " + last_line_);
}

void ChildProgram::takeWords() {
    char buffer[4096];
    ssize_t got = 0;
    while ((got = read(output_, buffer, sizeof(buffer))) > 0) {
        for (const char c : std::string_view(buffer, size_t(got))) {
            if (c == '\n')
                last_line_ = std::exchange(text_, {});
            else if (text_.size() < 65536)
                text_ += c;
        }
    }
}

bool ChildProgram::hasEnded() {
    if (pid_ < 0) return true;
    if (waitpid(pid_, &exit_status_, WNOHANG) != pid_) return false;
    takeWords();
    pid_ = -1;
    ended_ns_ = monotonicNowNs();
    return true;
}

void ChildProgram::lookAfter() {
    takeWords();
    if (!hasEnded()) return;
    if (WIFEXITED(exit_status_) && WEXITSTATUS(exit_status_) == 0) return;
    if (monotonicNowNs() - ended_ns_ < kRestartNs) return;
    spdlog::warn("{} has died: it is started again", path_);
    start();
}

void ChildProgram::tell(HandOrder order) noexcept {
    if (does_listen_ && pid_ > 0) tellHand(pid_, order);
}

std::string ChildProgram::finish() {
    if (!hasEnded()) kill(pid_, SIGTERM);
    for (const int64_t deadline_ns = monotonicNowNs() + kEndNs; !hasEnded();) {
        if (monotonicNowNs() > deadline_ns) kill(pid_, SIGKILL);
        usleep(10'000);
        takeWords();
    }
    if (output_ >= 0) close(std::exchange(output_, -1));
    return last_line_;
}

}  // namespace bonemill
