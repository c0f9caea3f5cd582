// Tokens and their hashes. Any thread.
#pragma once

#include <string>
#include <string_view>

namespace bonemill::gateway {

// Returns 64 hexadecimal digits.
std::string sha256Hex(std::string_view bytes);
// Returns 128 bits of the system's randomness as 32 hexadecimal digits. Throws std::runtime_error without
// any.
std::string randomToken();
// Takes the same time wherever they differ; texts of other lengths are different at once.
bool isSameSecret(const std::string& a, const std::string& b);

}  // namespace bonemill::gateway
