#include "common/config/scene_file.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "common/base/user_error.h"
#include "common/config/detached_data.h"
#include "common/config/scene_check.h"
#include "common/config/scene_text.h"
#include "common/text/text_encoding.h"

namespace bonemill {
namespace {

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

LoadedScene loadScene(const fs::path& file) {
    ParsedScene parsed = parseSceneText(readSceneText(file), file.string());
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
