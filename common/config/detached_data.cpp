#include "common/config/detached_data.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostHeaderBytes = size_t(1) << 20;
constexpr size_t kMaxFiles = 10'000;

std::string withoutBlanks(const std::string& text) {
    std::string name;
    for (const char c : text)
        if (!std::isspace(static_cast<unsigned char>(c)))
            name += char(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

std::string trimmed(const std::string& text) {
    const size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// "slice%03d.raw 1 40 1": the pattern, the first number, the last one, and the step.
std::vector<std::string> namesOfPattern(const std::string& text) {
    std::istringstream words(text);
    std::string pattern;
    int32_t first = 0, last = 0, step = 1;
    if (!(words >> pattern >> first >> last)) return {};
    if (!(words >> step)) step = 1;
    const size_t percent = pattern.find('%'), letter = pattern.find('d', percent);
    if (letter == std::string::npos || step == 0) return {};
    const std::string flags = pattern.substr(percent + 1, letter - percent - 1);
    const bool is_plain = std::ranges::all_of(flags, [](unsigned char c) { return std::isdigit(c); });
    if (!is_plain || flags.size() > 3) return {};
    const size_t width = flags.empty() ? 0 : std::stoul(flags);
    const char filling = flags.starts_with('0') ? '0' : ' ';
    std::vector<std::string> names;
    for (int64_t n = first; (step > 0 ? n <= last : n >= last) && names.size() <= kMaxFiles; n += step) {
        std::string number = std::to_string(n);
        number.insert(0, width > number.size() ? width - number.size() : 0, filling);
        names.push_back(pattern.substr(0, percent) + number + pattern.substr(letter + 1));
    }
    return names;
}

// What the header says in its field for data; `rest` stands behind that line.
std::vector<std::string> namesOf(const std::string& value, std::istream& rest) {
    if (value.empty() || withoutBlanks(value) == "local") return {};
    if (value.find('%') != std::string::npos) return namesOfPattern(value);
    if (!value.starts_with("LIST")) return {value};
    std::vector<std::string> names;
    for (std::string line; std::getline(rest, line) && names.size() <= kMaxFiles;)
        if (!trimmed(line).empty()) names.push_back(trimmed(line));
    return names;
}

std::vector<std::string> namesInHeader(std::istream& header) {
    std::string line;
    if (!std::getline(header, line)) return {};
    const bool is_nrrd = line.starts_with("NRRD000");
    do {
        const size_t sign = line.find(is_nrrd ? ':' : '=');
        if (is_nrrd && trimmed(line).empty()) return {};  // voxels come
        if (sign == std::string::npos || line.starts_with('#')) continue;
        const std::string field = withoutBlanks(line.substr(0, sign));
        if (field == (is_nrrd ? "datafile" : "elementdatafile"))
            return namesOf(trimmed(line.substr(sign + 1)), header);
    } while (std::getline(header, line));
    return {};
}

bool mayBeDetached(const fs::path& volume) {
    const std::string type = withoutBlanks(volume.extension().string());
    std::error_code error;
    return (type == ".nrrd" || type == ".nhdr" || type == ".mha" || type == ".mhd") &&
           fs::is_regular_file(volume, error);
}

}  // namespace

std::vector<fs::path> detachedDataOf(const fs::path& volume) {
    if (!mayBeDetached(volume)) return {};
    std::ifstream file(volume, std::ios::binary);
    std::string bytes(kMostHeaderBytes, '\0');
    file.read(bytes.data(), std::streamsize(bytes.size()));
    bytes.resize(size_t(file.gcount()));
    std::istringstream header(bytes);
    std::vector<fs::path> files;
    for (const std::string& name : namesInHeader(header))
        files.push_back((volume.parent_path() / name).lexically_normal());
    if (files.size() > kMaxFiles)
        throw UserError(volume.string() + ": names more than " + std::to_string(kMaxFiles) +
                        " files of voxels; put them into one");
    return files;
}

}  // namespace bonemill
