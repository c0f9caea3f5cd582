// Runs a part of a test in a process of its own.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <utility>

#include "tests/support/fork_child.h"

namespace bonemill {

inline constexpr int kSuccess = 0;

// The child process runs `body` and leaves with its result; it is killed if the test ends first.
class Child {
  public:
    explicit Child(const std::function<int()>& body) : pid_(test::forkChild()) {
        if (pid_ == 0) {
            int result = 99;
            try {
                result = body();
            } catch (...) {
            }
            _exit(result);
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() { kill(); }

    int exitCode() {
        int status = 0;
        waitpid(std::exchange(pid_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    // Returns once it stands still.
    void stop() {
        ::kill(pid_, SIGSTOP);
        waitpid(pid_, nullptr, WUNTRACED);
    }
    void goOn() { ::kill(pid_, SIGCONT); }
    void kill() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        waitpid(std::exchange(pid_, -1), nullptr, 0);
    }

  private:
    pid_t pid_;
};

}  // namespace bonemill
