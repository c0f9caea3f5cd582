// What others wrote, as it may be shown and go on. For normal threads.
#pragma once

#include <algorithm>
#include <string>

namespace bonemill {

// As a line for people: nothing in it moves a terminal's cursor, and it has an end. UTF-8 stays, cut between
// its letters; control characters become question marks.
inline std::string printableLine(std::string text, size_t most_bytes = 200) {
    const auto isInside = [](char c) { return (c & 0xc0) == 0x80; };
    if (text.size() > most_bytes) {
        while (most_bytes > 0 && isInside(text[most_bytes])) --most_bytes;
        text.resize(most_bytes);
        text += "...";
    }
    for (size_t i = 0; i < text.size(); ++i) {
        const bool is_c1 = text[i] == '\xc2' && i + 1 < text.size() && (text[i + 1] & 0xe0) == 0x80;
        const auto c = static_cast<unsigned char>(text[i]);
        if (c < ' ' || c == 0x7f) text[i] = '?';
        if (is_c1) text.replace(i, 2, "?");
    }
    return text;
}

// An answer may repeat only so much of what clients wrote, for answers are kept and sent to all.
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
