// The last steps of a child process before it becomes another program.
#pragma once

#include <signal.h>
#include <unistd.h>

#include <string>
#include <vector>

namespace bonemill {

// As execvp() wants them; they point into `words`.
inline std::vector<char*> argumentsOf(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    return arguments;
}

// Becomes the program, with no file of ours but its standard ones, and with the signals of a fresh program.
// Returns only where there is no such program. It may be called in a child of a program with threads.
inline void becomeProgram(const std::vector<char*>& arguments) noexcept {
    close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
    signal(SIGPIPE, SIG_DFL);
    execvp(arguments[0], arguments.data());
}

}  // namespace bonemill
