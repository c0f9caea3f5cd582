// Starts a program that goes on by itself: nobody waits for it, and it outlives who has started it.
#pragma once

#include <string>
#include <vector>

namespace bonemill {

// The first word is the program, a path or a name in $PATH. Returns at once; false where there is no such
// program. Not RT-safe.
bool startApart(const std::vector<std::string>& words);

}  // namespace bonemill
