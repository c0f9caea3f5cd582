#include "haptic_server/teaching/lessons/scene_folder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/config/scene_tools.h"
#include "common/files/require_file.h"
#include "common/process/run_captured.h"
#include "common/text/foreign_text.h"
#include "common/text/text_encoding.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr char kEnding[] = ".textproto";
constexpr size_t kLongestId = 64;
constexpr double kSecondsPerMinute = 60;

// It goes into commands, reports and names of files.
bool isId(const std::string& name) {
    const auto is_allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-' || c == '.';
    };
    return !name.empty() && name.size() <= kLongestId && std::all_of(name.begin(), name.end(), is_allowed);
}

// Anything but a small PNG file is no picture.
std::string pictureOf(const fs::path& file) {
    constexpr char kBegin[] = "\x89PNG\r\n\x1a\n";
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > kMaxPictureBytes || error)
        return "";
    std::ifstream stream(file, std::ios::binary);
    std::string bytes(kMaxPictureBytes, '\0');
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    bytes.resize(size_t(stream.gcount()));
    return bytes.rfind(kBegin, 0) == 0 ? bytes : "";
}

bool isThere(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error);
}

// Everybody in the session reads what is wrong with a scene: folders of this PC stay private.
void noteMissing(const LoadedScene& loaded, const SceneMaker& maker, ListedScene& listed) {
    topics::SceneChoice& choice = listed.choice;
    const bool is_makeable = std::ranges::count(maker.ids, choice.id()) > 0;
    for (const NamedFile& file : filesOf(loaded)) {
        if (isThere(file.path)) continue;
        listed.missing.push_back(file.path);
        if (is_makeable)
            choice.set_is_made_first(true);
        else if (choice.problem().empty())
            choice.set_problem(file.name + " " + file.path.filename().string() + ": no such file or folder");
    }
}

void describe(const fs::path& file, const SceneMaker& maker, ListedScene& listed) {
    const LoadedScene loaded = loadScene(file);
    topics::SceneChoice& choice = listed.choice;
    for (NamedFile& read : filesOf(loaded)) {
        read.name += " of " + choice.id();
        listed.files.push_back(std::move(read));
    }
    const scene::Scene& scene = loaded.scene;
    if (!titleOf(scene).empty()) choice.set_title(titleOf(scene));
    choice.set_task(scene.task());
    choice.set_expected_s(kSecondsPerMinute * scene.expected_minutes());
    for (const std::string& tool : toolNamesOf(scene)) choice.add_tools(tool);
    noteMissing(loaded, maker, listed);
}

std::string withoutFolder(std::string text, const fs::path& file) {
    const std::string folder = (file.parent_path() / "").string();
    for (size_t at = text.find(folder); !folder.empty() && at != std::string::npos;
         at = text.find(folder, at))
        text.erase(at, folder.size());
    return text;
}

ListedScene listed(const fs::path& file, const SceneMaker& maker) {
    ListedScene scene{.choice = {}, .file = file.string()};
    scene.files = {{"the scene file", file},
                   {"the scene's picture", fs::path(file).replace_extension(".png")},
                   {"the scene's figures", accuracyFiguresOf(file.string())}};
    scene.choice.set_id(file.stem().string());
    scene.choice.set_title(scene.choice.id());
    scene.choice.set_picture(pictureOf(fs::path(file).replace_extension(".png")));
    try {
        describe(file, maker, scene);
    } catch (const std::exception& error) {
        scene.choice.set_problem(withoutFolder(error.what(), file));
    }
    return scene;
}

std::vector<fs::path> sceneFilesOf(const std::string& folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == kEnding) files.push_back(entry->path());
    if (error) throw UserError("--scenes " + folder + ": cannot be read: " + error.message());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

AccuracyFigures readAccuracyFigures(const std::string& file) {
    requireFile(file);
    std::ifstream stream(file);
    if (!stream) throw UserError(file + ": cannot be read");
    std::string text(std::istreambuf_iterator<char>(stream), {});
    requireUtf8(text, file);
    try {
        AccuracyFigures figures;
        const nlohmann::json json = nlohmann::json::parse(text);
        for (const auto& [name, figure] : json.at("settings").items())
            figures[name] = {figure.at("force_error_percent").get<double>(),
                             figure.at("direction_error_deg").get<double>()};
        return figures;
    } catch (const nlohmann::json::exception& error) {
        throw UserError(file + ": is no accuracy.json of accuracy-report: " + error.what());
    }
}

std::string accuracyFiguresOf(const std::string& scene_file) {
    return std::filesystem::path(scene_file).replace_extension(".accuracy.json").string();
}

std::vector<ListedScene> listScenes(const std::vector<std::string>& folders, const SceneMaker& maker) {
    std::vector<ListedScene> scenes;
    for (const std::string& folder : folders)
        for (const fs::path& file : sceneFilesOf(folder)) {
            const std::string id = file.stem().string();
            const bool is_known = std::any_of(scenes.begin(), scenes.end(),
                                              [&](const ListedScene& s) { return s.choice.id() == id; });
            if (!isId(id))
                spdlog::warn("{}: is not listed: letters, digits, _ - and . make a name", repeatedText(id));
            else if (is_known)
                spdlog::warn("{}: is not listed: another folder has a scene of that name", file.string());
            else if (scenes.size() == kMaxListedScenes)
                spdlog::warn("{}: is not listed: there are {} already", file.string(), kMaxListedScenes);
            else
                scenes.push_back(listed(file, maker));
        }
    return scenes;
}

bool lacksFiles(const ListedScene& scene) {
    return !std::ranges::all_of(scene.missing, isThere);
}

void makeMissing(const ListedScene& scene, const SceneMaker& maker) {
    const Captured made = runCaptured({maker.program, "prepare", scene.file});
    if (made.exit_code == 0 && !lacksFiles(scene)) return;
    const std::string why = made.err.substr(0, made.err.find_last_not_of('\n') + 1);
    throw UserError("what " + scene.choice.id() +
                    " reads could not be made: " + printableLine(why.substr(why.rfind('\n') + 1)));
}

std::string sceneTable(const std::vector<ListedScene>& scenes) {
    std::string table;
    for (const ListedScene& scene : scenes) {
        const topics::SceneChoice& choice = scene.choice;
        char line[400];
        std::snprintf(line, sizeof line, "%-18s %4.0f min  %zu kB picture  %s\n", choice.id().c_str(),
                      choice.expected_s() / kSecondsPerMinute, (choice.picture().size() + 1023) / 1024,
                      choice.title().c_str());
        table += line;
        if (!choice.problem().empty()) table += "    cannot be chosen: " + choice.problem() + "\n";
        if (choice.is_made_first()) table += "    what it reads is made when it is chosen: some seconds\n";
    }
    return table;
}

std::string idOfScene(const std::vector<ListedScene>& scenes, const std::string& file) {
    for (const ListedScene& scene : scenes)
        if (isSameFile(scene.file, file)) return scene.choice.id();
    return "";
}

}  // namespace bonemill
