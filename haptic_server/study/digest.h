// SHA-256 of files and texts, by which a study says what exactly was used. It is for one thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace bonemill::study {

// 64 hexadecimal digits.
std::string sha256Of(std::string_view bytes);
// Empty when the file cannot be read.
std::string sha256OfFile(const std::filesystem::path& path);

}  // namespace bonemill::study
