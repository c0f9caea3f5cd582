// Text as people's editors and other programs write it: UTF-8, of which a byte order mark is passed over;
// UTF-16 is refused in words. For normal threads.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/user_error.h"

namespace bonemill {

// Takes the mark of UTF-8 off the beginning of a text. Throws UserError, which names the file, where the text
// is UTF-16 or UTF-32: there every second byte of its first letters is zero, or a mark says so.
inline void requireUtf8(std::string& text, const std::string& file) {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (text.starts_with(kMark)) text.erase(0, kMark.size());
    const bool has_mark = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    if (has_mark || text.substr(0, 2).find('\0') != std::string::npos)
        throw UserError(file + ": is UTF-16; save it as UTF-8");
}

// How many bytes the letter of UTF-8 has that begins there; 0: it is none, or a control character.
inline size_t letterBytes(std::string_view text, size_t at) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    const uint8_t first = byte(at);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const size_t count = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4) return 0;
    for (size_t i = 1; i < count; ++i)
        if ((byte(at + i) & 0xc0) != 0x80) return 0;
    const bool is_overlong = (first == 0xe0 && byte(at + 1) < 0xa0) || (first == 0xf0 && byte(at + 1) < 0x90);
    const bool is_no_letter =
        (first == 0xed && byte(at + 1) > 0x9f) || (first == 0xf4 && byte(at + 1) > 0x8f);
    return is_overlong || is_no_letter || (first == 0xc2 && byte(at + 1) < 0xa0) ? 0 : count;
}

}  // namespace bonemill
