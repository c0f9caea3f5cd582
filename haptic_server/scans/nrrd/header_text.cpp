#include "haptic_server/scans/nrrd/header_text.h"

#include <fstream>

namespace bonemill {

std::string firstBytes(const std::filesystem::path& path, size_t most) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes(most, '\0');
    file.read(bytes.data(), std::streamsize(most));
    bytes.resize(size_t(file.gcount()));
    return bytes;
}

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace bonemill
