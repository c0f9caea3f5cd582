// Numbers and names as the figures over the picture show them. Pure functions, any thread.
#pragma once

#include <string>

namespace bonemill {

// What stands for a value that is no number: a dash.
inline constexpr char kNoNumber[] = "\u2013";

// The number with so many decimals, and its unit.
std::string figureText(double value, int decimals, const char* unit);
// Three significant digits or so, whatever the size.
std::string readableText(double value, const char* unit);
// At most that many signs (UTF-8), the last one an ellipsis if some are left out.
std::string shortenedText(const std::string& text, size_t most);

}  // namespace bonemill
