#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "tests/support/fork_child.h"
#include "tests/support/places.h"

namespace bonemill::test {
namespace {

using namespace std::chrono_literals;

void redirect(int descriptor, const std::string& file) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(opened, descriptor);
    close(opened);
}

// A name is that of a program of the build, or of its twin in BONEMILL_GUARDED_DIR where ctest sets that and
// there is one.
std::filesystem::path programOf(const std::string& name) {
    if (name.find('/') != std::string::npos) return name;
    if (const char* folder = getenv("BONEMILL_GUARDED_DIR"))
        if (const std::filesystem::path twin = std::filesystem::path(folder) / name; exists(twin))
            return twin;
    return std::filesystem::path(test::binDir()) / name;
}

// That of this process, but for the folder where programs keep their state.
std::vector<std::string> environmentWith(const std::string& state_folder) {
    constexpr std::string_view kState = "XDG_STATE_HOME=";
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable)
        if (!std::string_view(*variable).starts_with(kState)) variables.emplace_back(*variable);
    variables.push_back(std::string(kState) + state_folder);
    return variables;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments) {
    std::vector<std::string> words = arguments;
    words[0] = programOf(arguments[0]).string();
    std::vector<std::string> variables = environmentWith(folder_ / "state");
    const std::vector<char*> argv = pointersTo(words), environment = pointersTo(variables);
    pid_ = forkChild();
    if (pid_ != 0) return;
    redirect(STDOUT_FILENO, folder_ / "out");
    redirect(STDERR_FILENO, folder_ / "err");
    execve(argv[0], argv.data(), environment.data());
    _exit(127);
}

Process::~Process() {
    if (isRunning()) {
        signal(SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
}

void Process::signal(int number) const {
    kill(pid_, number);
}

bool Process::isRunning() {
    if (!has_ended_) has_ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return !has_ended_;
}

Finished Process::wait(std::chrono::seconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (isRunning() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(10ms);
    Finished finished;
    if (has_ended_) {
        finished.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    } else {
        signal(SIGKILL);
        waitpid(pid_, nullptr, 0);
        has_ended_ = true;
    }
    finished.out = readFile(folder_ / "out");
    finished.err = readFile(folder_ / "err");
    return finished;
}

std::string Process::outSoFar() const {
    return readFile(folder_ / "out");
}

std::string Process::errSoFar() const {
    return readFile(folder_ / "err");
}

Finished run(const std::vector<std::string>& arguments) {
    return Process(arguments).wait();
}

void writeFile(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

int workOf(const Process& program) {
    const std::string pid = std::to_string(program.pid());
    std::ifstream children("/proc/" + pid + "/task/" + pid + "/children");
    int work = 0;
    children >> work;
    return work;
}

std::string readFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    return content.str();
}

bool waitFor(const std::function<bool()>& condition, std::chrono::seconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        std::this_thread::sleep_for(20ms);
    }
    return true;
}

}  // namespace bonemill::test
