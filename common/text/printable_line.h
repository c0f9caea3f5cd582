// What others wrote, as a line for people: nothing in it moves a terminal's cursor, and it has an end. For
// normal threads.
#pragma once

#include <algorithm>
#include <string>

namespace bonemill {

// UTF-8 stays, cut between its letters; control characters become question marks.
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

}  // namespace bonemill
