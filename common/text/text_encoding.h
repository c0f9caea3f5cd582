// Text files as people's editors save them: a byte order mark is passed over, UTF-16 is refused in words. It
// is for start-up only.
#pragma once

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

}  // namespace bonemill
