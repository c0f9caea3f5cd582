#include "tests/integration/dds/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <utility>

#include "tests/support/dds_session.h"
#include "tests/support/fork_child.h"
#include "tests/support/places.h"

namespace bonemill {

ChildProcess::ChildProcess(const std::string& name, std::string argument) {
    int input[2], output[2];
    // The pipes close on exec: a child that held another one's pipe would keep that one from ending.
    if (pipe2(input, O_CLOEXEC) != 0 || pipe2(output, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    std::string path = test::helperDir() + "/" + name;
    std::string domain = std::to_string(testDomain()), session = std::to_string(testSession());
    char* const arguments[] = {path.data(), domain.data(), session.data(), argument.data(), nullptr};
    pid_ = test::forkChild();
    if (pid_ == 0) {
        dup2(input[0], STDIN_FILENO);
        dup2(output[1], STDOUT_FILENO);
        execv(path.c_str(), arguments);
        _exit(127);
    }
    close(input[0]);
    close(output[1]);
    to_child_ = input[1];
    from_child_ = output[0];
    if (pid_ < 0) throw std::runtime_error("cannot start " + path);
}

ChildProcess::~ChildProcess() {
    kill();
    if (to_child_ >= 0) close(to_child_);
    close(from_child_);
}

void ChildProcess::finish() {
    close(std::exchange(to_child_, -1));
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
}

void ChildProcess::kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
}

std::string ChildProcess::readLine() {
    std::string line;
    char c = 0;
    pollfd output{from_child_, POLLIN, 0};
    while (poll(&output, 1, 30000) > 0 && read(from_child_, &c, 1) == 1) {
        if (c == '\n') return line;
        line += c;
    }
    return {};
}

bool ChildProcess::tell(const std::string& line) {
    const std::string text = line + "\n";
    return write(to_child_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

std::string ChildProcess::ask(const std::string& line) {
    return tell(line) ? readLine() : std::string();
}

}  // namespace bonemill
