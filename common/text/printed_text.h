// Numbers and foreign texts in what people read.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
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

// As one word for a shell.
inline std::string quoted(const std::string& word) {
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("/._-+,:@", c); };
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

// As a scene's text, in the quotes that it needs.
inline std::string sceneText(const std::string& word) {
    std::string text = "\"";
    for (const char c : word) text += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return text + "\"";
}

}  // namespace bonemill
