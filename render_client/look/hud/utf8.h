// Reads text as code points. The functions are pure; any thread may call them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace bonemill {

// Returns the code points of UTF-8 text; each broken byte becomes U+FFFD.
std::vector<uint32_t> decodeUtf8(std::string_view text);

}  // namespace bonemill
