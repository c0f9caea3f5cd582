// Runs a program to its end and takes what it prints.
#pragma once

#include <string>
#include <vector>

namespace bonemill {

struct Captured {
    int exit_code = -1;  // 128 + signal where it was killed; 127 where there is no such program
    std::string out, err;
};

// The first word is the program, a path or a name in $PATH. Waits until it has ended and its output is
// closed; of each output the first kMostCaptured bytes are kept. Throws std::system_error where no process
// can be made. Any thread may call it; not RT-safe.
inline constexpr size_t kMostCaptured = size_t(64) << 10;
Captured runCaptured(const std::vector<std::string>& words);

}  // namespace bonemill
