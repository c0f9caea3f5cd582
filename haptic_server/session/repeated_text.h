// An answer may repeat only so much of what a client wrote, for answers are kept and sent to all.
#pragma once

#include <algorithm>
#include <string>

namespace bonemill {

inline std::string repeatedText(const std::string& text) {
    constexpr size_t kMost = 32;  // longer than any preset's name
    std::string start = text.substr(0, kMost);
    std::replace_if(
        start.begin(), start.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text.size() > kMost ? start + "..." : start;
}

}  // namespace bonemill
