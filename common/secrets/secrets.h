// Randomness, tokens, their hashes, and how secrets are compared. Any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace bonemill {

// Returns two digits for each byte, small letters.
std::string hexOf(std::span<const unsigned char> bytes);
// Returns 64 hexadecimal digits.
std::string sha256Hex(std::string_view bytes);
// Fills it from the system's random source. Throws std::runtime_error without one.
void fillRandom(void* bytes, size_t count);
// Returns 128 random bits as 32 hexadecimal digits. Throws std::runtime_error.
std::string randomToken();
// Takes the same time wherever they differ; texts of other lengths are different at once.
bool isSameSecret(std::string_view a, std::string_view b);

// Returns the secret that is shared by hand, out of a file that others may not read: at least 32 letters,
// without blanks at its ends. `whose` is for people: "a relay". Throws UserError.
std::string readSecret(const std::string& path, const std::string& whose);

}  // namespace bonemill
