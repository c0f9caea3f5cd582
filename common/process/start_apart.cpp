#include "common/process/start_apart.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bonemill {

// The child's child is nobody's to wait for. A pipe that exec closes tells whether there was a program.
bool startApart(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    int failed[2];
    if (pipe2(failed, O_CLOEXEC) != 0) return false;
    const pid_t child = fork();
    if (child == 0) {
        if (setsid() < 0 || fork() != 0) _exit(0);
        execvp(arguments[0], arguments.data());
        const char sign = 1;
        _exit(write(failed[1], &sign, 1) == 1 ? 1 : 2);
    }
    close(failed[1]);
    char sign = 0;
    if (child > 0) waitpid(child, nullptr, 0);
    const bool is_started = child > 0 && read(failed[0], &sign, 1) == 0;
    close(failed[0]);
    return is_started;
}

}  // namespace bonemill
