// Loads a scene: one text file (deploy/scenes/*.textproto, schema proto/scene.proto) says everything.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/scene_text.h"
#include "common/files/require_apart.h"

namespace bonemill {

struct LoadedScene {
    scene::Scene scene;
    std::filesystem::path directory;  // absolute folder of `file`: where the scene's relative paths start
    std::filesystem::path file;       // as given
    FieldLines lines;                 // for messages: placeOf()
};

// Reads and checks a scene, with `settings` in place of what the file says (setField()). Throws UserError
// with "file:line: ..." for a missing, unreadable or too large file, bad syntax, an unknown field, a value
// outside its range and fields in conflict. It is for start-up only.
LoadedScene loadScene(const std::filesystem::path& file, const std::vector<std::string>& settings = {});

// Tells scenes apart by all that their fields say, whatever the order and the comments of the text: server
// and daemon of a session compare it. It is stable from release to release only as long as the schema is.
uint64_t sceneHashOf(const scene::Scene& scene);

// People read this in lists, over the picture and in reports: the scene's title, or without one its name.
const std::string& titleOf(const scene::Scene& scene);

// A path written in the scene points there: absolute paths stay, relative ones start at the
// scene file's folder.
std::filesystem::path resolvePath(const LoadedScene& loaded, const std::string& path_in_scene);

// They are the scene itself and all that it names, with the data of detached volumes: whoever writes must
// spare them (requireApart()).
std::vector<NamedFile> filesOf(const LoadedScene& loaded);

// The files in which a volume has its voxels, where a header names them: a detached NRRD or MetaImage. One
// file, a LIST of them, or a pattern with numbers, as both formats write them; none for any other volume, and
// none for a header that makes no sense, of which the import says so. Throws UserError if they are more than
// anybody's volume has.
std::vector<std::filesystem::path> detachedDataOf(const std::filesystem::path& volume);

}  // namespace bonemill
