// The scenes that people can choose: the scene files of some folders, as a list for viewers and for a
// terminal, and what was measured for each.
//
// It is for start-up: reads files, allocates. A file that cannot be a scene is listed with what is wrong with
// it and never ends the program.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/files/require_apart.h"
#include "proto/topics.pb.h"

namespace bonemill {

// accuracy-report has measured this for a scene: the errors of each accuracy setting, by its name.
struct AccuracyFigure {
    double force_error_percent = 0;
    double direction_error_deg = 0;
};
using AccuracyFigures = std::map<std::string, AccuracyFigure>;

// `file` is what accuracy-report writes (accuracy.json). Throws UserError for any other file.
AccuracyFigures readAccuracyFigures(const std::string& file);

// The figures of a scene lie there if they were kept: beside the scene, X.textproto -> X.accuracy.json.
std::string accuracyFiguresOf(const std::string& scene_file);

struct ListedScene {
    topics::SceneChoice choice;
    std::string file;
    std::vector<NamedFile> files = {};                // all that the scene reads
    std::vector<std::filesystem::path> missing = {};  // of these, when it was listed
};

// A program that makes what scenes of these ids read: PROGRAM prepare SCENE_FILE.
struct SceneMaker {
    std::string program;
    std::vector<std::string> ids = {};
};

// How many are listed at most; viewers take no more.
inline constexpr size_t kMaxListedScenes = 64;
inline constexpr size_t kMaxPictureBytes = 64u << 10;

// Lists `*.textproto` of each folder by name, in the order of the folders. Of two files of one name the first
// counts. What a scene names is looked for, not read: title, task, tools, time, and the picture `NAME.png`
// beside it. Throws UserError for a folder that cannot be read.
// What a scene lacks and `maker` makes is no problem.
std::vector<ListedScene> listScenes(const std::vector<std::string>& folders, const SceneMaker& maker = {});

// Something that the scene lacked when it was listed is not there now, either.
bool lacksFiles(const ListedScene& scene);

// Makes what it lacks, which takes seconds. Throws UserError with the maker's last words.
void makeMissing(const ListedScene& scene, const SceneMaker& maker);

// One line per scene, and one more for what is wrong with it.
std::string sceneTable(const std::vector<ListedScene>& scenes);

// The id of the listed scene that is this file, or "".
std::string idOfScene(const std::vector<ListedScene>& scenes, const std::string& file);

}  // namespace bonemill
