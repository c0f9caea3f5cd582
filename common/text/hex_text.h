// Writes 64 bits as 16 hexadecimal digits, as render_client prints its digest, for JSON readers do not keep
// 64 bits of a number.
#pragma once

#include <cinttypes>
#include <cstdio>
#include <string>

namespace bonemill {

inline std::string hexText(uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, value);
    return text;
}

}  // namespace bonemill
