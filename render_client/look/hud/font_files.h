// Finds the font files that figures and panel are written in. It is for any thread.
#pragma once

#include <string>

namespace bonemill {

enum class FontStyle { kPlain, kBold };

// Returns the path of the installed file. Throws UserError when it is not installed.
std::string fontFile(FontStyle style);

}  // namespace bonemill
