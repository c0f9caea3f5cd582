// What clients wrote, as it may go on to others: an answer may repeat only so much of it, for answers are
// kept and sent to all.
#pragma once

#include <algorithm>
#include <string>

namespace bonemill {

inline std::string repeatedText(const std::string& text) {
    constexpr size_t kMax = 32;  // longer than any preset's name
    std::string start = text.substr(0, kMax);
    std::replace_if(
        start.begin(), start.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text.size() > kMax ? start + "..." : start;
}

// Returns whether UTF-8 text has control characters.
inline bool hasUnprintable(const std::string& text) {
    for (size_t i = 0; i < text.size(); ++i) {
        const auto c = (unsigned char)text[i];
        const bool is_c1 = c == 0xc2 && i + 1 < text.size() && (unsigned char)text[i + 1] < 0xa0;
        if (c < ' ' || c == 0x7f || is_c1) return true;
    }
    return false;
}

}  // namespace bonemill
