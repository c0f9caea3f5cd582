// What others wrote, as it may be shown and go on. For normal threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace bonemill {

// Here is decided which characters of a text in UTF-8 people cannot see for what they are: controls (C0, C1),
// marks and overrides of the direction of writing, spaces without width, separators of lines, tags. The
// joiners U+200C and U+200D stay: Persian, Indic scripts and pictograms are written with them. Returns how
// many bytes such a character has that begins at `i`; 0: what is there can be seen.
inline size_t unprintableBytes(const std::string& text, size_t i) {
    const auto byte = [&](size_t n) { return i + n < text.size() ? (unsigned char)text[i + n] : 0u; };
    if (byte(0) < ' ' || byte(0) == 0x7f) return 1;
    const char32_t two = (byte(0) & 0x1f) << 6 | (byte(1) & 0x3f),
                   three = (byte(0) & 0x0f) << 12 | (byte(1) & 0x3f) << 6 | (byte(2) & 0x3f);
    const auto isIn = [](char32_t c, char32_t first, char32_t last) { return c >= first && c <= last; };
    if ((byte(0) & 0xe0) == 0xc0 && (isIn(two, 0x80, 0x9f) || two == 0xad || two == 0x61c)) return 2;
    if ((byte(0) & 0xf0) == 0xe0 &&
        (three == 0x180e || three == 0x200b || isIn(three, 0x200e, 0x200f) || isIn(three, 0x2028, 0x202e) ||
         isIn(three, 0x2060, 0x206f) || three == 0xfeff || isIn(three, 0xfff9, 0xfffb)))
        return 3;
    return byte(0) == 0xf3 && byte(1) == 0xa0 && isIn(byte(2), 0x80, 0x81) ? 4 : 0;
}

// As a line for people: nothing in it moves a terminal's cursor or turns what stands beside it, and it has an
// end. UTF-8 stays, cut between its letters; each unprintable character becomes a question mark.
inline std::string printableLine(std::string text, size_t most_bytes = 200) {
    const auto isInside = [](char c) { return (c & 0xc0) == 0x80; };
    if (text.size() > most_bytes) {
        while (most_bytes > 0 && isInside(text[most_bytes])) --most_bytes;
        text.resize(most_bytes);
        text += "...";
    }
    for (size_t i = 0; i < text.size(); ++i)
        if (const size_t bytes = unprintableBytes(text, i)) text.replace(i, bytes, "?");
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

// Returns whether UTF-8 text has characters that people cannot see for what they are.
inline bool hasUnprintable(const std::string& text) {
    for (size_t i = 0; i < text.size(); ++i)
        if (unprintableBytes(text, i) > 0) return true;
    return false;
}

}  // namespace bonemill
