// Reads a header of text from the start of a file that may be endless: one line of it could fill the memory.
#pragma once

#include <filesystem>
#include <string>

namespace bonemill {

// These are the file's first bytes, `most` of them where it has as many; none when it cannot be read.
std::string firstBytes(const std::filesystem::path& path, size_t most);

// The text without blanks and the carriage return of a line around it.
std::string trimmed(const std::string& text);

}  // namespace bonemill
