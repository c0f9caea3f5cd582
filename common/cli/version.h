// What --version prints after the program's name.
#pragma once

#include <string>

namespace bonemill {

// "0.1.0 (b7bbafd)": the project's version, and the commit that was built, if it was built from a Git
// checkout; "-dirty" behind it where files had been changed since.
std::string versionText();

}  // namespace bonemill
