// What --version prints after the program's name.
#pragma once

#include <string>

namespace bonemill {

// "0.1.0 (b7bbafd; Release, hardened, GNU 12.2.0)": the project's version, the commit that was built, if it
// was built from a Git checkout, with "-dirty" behind it where files had been changed since, and how.
std::string versionText();

}  // namespace bonemill
