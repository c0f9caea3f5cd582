// Runs our programs as a user would, as whole processes with exit codes and what they print.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace bonemill::test {

struct Finished {
    int exit_code = -1;  // 128 + signal when killed, -1 when it ran past the time limit (and was killed)
    std::string out;
    std::string err;
};

// Runs a child process; its output goes to files in its own temporary folder, and so does what it
// keeps in $XDG_STATE_HOME, which tests must not clutter. It is killed when the object goes, and ends when
// this process does. Make it in the main thread.
class Process {
  public:
    // The first argument is a program's name in the build's bin folder, or a path.
    explicit Process(const std::vector<std::string>& arguments);
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process();

    void signal(int number) const;
    bool isRunning();
    int pid() const { return pid_; }
    Finished wait(std::chrono::seconds limit = std::chrono::seconds(120));
    // They return what it has printed so far.
    std::string outSoFar() const;
    std::string errSoFar() const;

  private:
    TemporaryFolder folder_;
    int pid_ = -1;
    int status_ = 0;
    bool has_ended_ = false;
};

Finished run(const std::vector<std::string>& arguments);

// Returns the process that does the work of a program which looks after it (common/process/supervisor.h); 0:
// there is none at the moment.
int workOf(const Process& program);

void writeFile(const std::string& path, const std::string& content);
std::string readFile(const std::string& path);

// Looks again and again until the condition holds. It returns false when it never did: the limit only ends a
// test that hangs.
bool waitFor(const std::function<bool()>& condition, std::chrono::seconds limit = std::chrono::seconds(100));

}  // namespace bonemill::test
