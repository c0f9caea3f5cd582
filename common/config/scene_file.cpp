#include "common/config/scene_file.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "common/base/user_error.h"
#include "common/config/scene_check.h"
#include "common/config/scene_settings.h"
#include "common/text/text_encoding.h"

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

namespace fs = std::filesystem;

constexpr uintmax_t kMaxSceneBytes =
    4 << 20;  // a scene is written by hand: a megabyte is already 10,000 waypoints

std::string readSceneText(const fs::path& file) {
    const auto fail = [&file](const std::string& why) -> UserError {
        return UserError(file.string() + ": " + why);
    };
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) throw fail("scene file not found");
    if (error) throw fail("scene file cannot be reached: " + error.message());
    if (!fs::is_regular_file(status)) throw fail("is not a file; a scene is a .textproto file");
    const uintmax_t size = fs::file_size(file, error);
    if (error) throw fail("scene file cannot be reached: " + error.message());
    if (size > kMaxSceneBytes)
        throw fail("is " + std::to_string(size) + " bytes; a scene has at most " +
                   std::to_string(kMaxSceneBytes));

    std::ifstream stream(file, std::ios::binary);
    std::string text(size, '\0');
    if (!stream.read(text.data(), std::streamsize(size))) throw fail("scene file cannot be read");
    requireUtf8(text, file.string());
    return text;
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

LoadedScene loadScene(const fs::path& file, const std::vector<std::string>& settings) {
    ParsedScene parsed = parseSceneText(readSceneText(file), file.string());
    for (const std::string& setting : settings) setField(parsed.scene, setting);
    checkScene(parsed, file.string());
    return {std::move(parsed.scene), fs::absolute(file).parent_path().lexically_normal(), file,
            std::move(parsed.lines)};
}

uint64_t sceneHashOf(const scene::Scene& scene) {
    std::string bytes;
    {
        google::protobuf::io::StringOutputStream stream(&bytes);
        google::protobuf::io::CodedOutputStream coded(&stream);
        coded.SetSerializationDeterministic(true);
        scene.SerializeToCodedStream(&coded);
    }
    uint64_t hash = 14695981039346656037ull;  // FNV-1a
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ull;
    return hash;
}

const std::string& titleOf(const scene::Scene& scene) {
    return scene.title().empty() ? scene.name() : scene.title();
}

fs::path resolvePath(const LoadedScene& loaded, const std::string& path_in_scene) {
    return (loaded.directory / path_in_scene).lexically_normal();
}

std::vector<NamedFile> filesOf(const LoadedScene& loaded) {
    std::vector<NamedFile> files{{"the scene", loaded.file}};
    const auto add = [&](const std::string& field, const std::string& path) {
        if (!path.empty()) files.push_back({"the scene's " + field, resolvePath(loaded, path)});
    };
    const auto addVolume = [&](const std::string& field, const std::string& path) {
        add(field, path);
        if (path.empty()) return;
        for (fs::path& data : detachedDataOf(resolvePath(loaded, path)))
            files.push_back({"the scene's " + field + ", its data", std::move(data)});
    };
    addVolume("volume.path", loaded.scene.volume().path());
    addVolume("volume.label_path", loaded.scene.volume().label_path());
    for (const scene::Tool& tool : loaded.scene.tool()) add("tool.mesh_path", tool.mesh_path());
    addVolume("assessment.reference.volume_path", loaded.scene.assessment().reference().volume_path());
    add("assessment.expert_path", loaded.scene.assessment().expert_path());
    return files;
}

}  // namespace bonemill
