#include "haptic_server/recording/rerun/recorded_scene.h"

#include <filesystem>

#include "common/base/user_error.h"
#include "common/config/scene_check.h"
#include "common/config/scene_text.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/journal/build_facts.h"

namespace bonemill {
namespace {

const journal::File* listedFile(const journal::Manifest& manifest, const NamedFile& file) {
    const std::string path = std::filesystem::absolute(file.path).lexically_normal();
    for (const journal::File& listed : manifest.files())
        if (listed.path() == path) return &listed;
    return nullptr;
}

// Its text is in the journal.
bool isSceneFile(const NamedFile& file, const LoadedScene& scene) {
    return file.path == scene.file;
}

}  // namespace

LoadedScene recordedScene(const journal::Manifest& manifest, const std::string& journal) {
    const std::filesystem::path file = manifest.scene_path();
    if (!file.is_absolute()) throw UserError(journal + ": does not say where its scene was; it is damaged");
    const std::string name = "the scene in the journal, " + printableLine(file.string());
    ParsedScene parsed = parseSceneText(manifest.scene_text(), name);
    checkScene(parsed, name);
    LoadedScene scene{std::move(parsed.scene), file.parent_path().lexically_normal(), file,
                      std::move(parsed.lines)};
    for (const NamedFile& read : filesOf(scene))
        if (!isSceneFile(read, scene) && !listedFile(manifest, read))
            throw UserError(journal + ": its scene reads " + read.name + " " +
                            printableLine(read.path.string()) +
                            ", which the session did not read; the journal is damaged or forged");
    return scene;
}

std::vector<std::string> changedFiles(const journal::Manifest& manifest, const LoadedScene& scene) {
    std::vector<std::string> changed;
    for (const NamedFile& read : filesOf(scene)) {
        if (isSceneFile(read, scene)) continue;
        const journal::File* const listed = listedFile(manifest, read);
        if (!listed || listed->sha256() != sha256Of(read.path))
            changed.push_back(read.name + " " + printableLine(read.path.string()) + " is another file now");
    }
    return changed;
}

}  // namespace bonemill
