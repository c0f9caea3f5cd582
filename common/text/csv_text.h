// Text as a field of a table that a spreadsheet opens. Pure; any thread may call it.
#pragma once

#include <cstring>
#include <string>

namespace bonemill {

// Makes one field of it, in quotes. A spreadsheet takes what begins with = + - or @ for a formula, so an
// apostrophe goes before.
inline std::string csvText(const std::string& text) {
    std::string field = "\"";
    if (!text.empty() && std::strchr("=+-@\t\r", text[0])) field += '\'';
    for (const char c : text) {
        if (c == '"') field += '"';
        field += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return field + '"';
}

}  // namespace bonemill
