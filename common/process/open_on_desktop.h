// Has the desktop open a file or folder with the program that the user has for it.
#pragma once

#include <string>

namespace bonemill {

// Returns at once; false where there is no xdg-open. What becomes of it is the desktop's. The other program
// outlives this one. Not RT-safe.
bool openOnDesktop(const std::string& file);

}  // namespace bonemill
