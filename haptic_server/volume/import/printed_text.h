// Numbers and foreign texts in what people read.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

namespace bonemill {

// As printf; what is longer than a message's part ends there.
std::string printed(const char* format, auto... numbers) {
    char text[200];
    std::snprintf(text, sizeof text, format, numbers...);
    return text;
}

// Nothing in it can end a line or command a terminal, in no coding of letters.
inline std::string printable(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

}  // namespace bonemill
