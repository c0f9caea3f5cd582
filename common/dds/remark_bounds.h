// So much of what people write and draw a session keeps and a viewer takes (topics::Remark). It is for any
// thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace bonemill {

inline constexpr uint32_t kMaxRemarks = 256;  // at once; places are counted from 0
inline constexpr int kMaxRemarkPoints = 300;  // of a stroke
inline constexpr size_t kMaxNoteLetters = 300;

// Returns the letters of UTF-8 text: bytes that go on with one do not count.
inline size_t lettersOf(const std::string& text) {
    return size_t(std::ranges::count_if(text, [](char c) { return (uint8_t(c) & 0xc0) != 0x80; }));
}

// Returns what this many bytes hold of UTF-8 text, in whole letters.
inline std::string cutToBytes(const std::string& text, size_t most) {
    size_t end = std::min(most, text.size());
    while (end > 0 && end < text.size() && (uint8_t(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end);
}

}  // namespace bonemill
