#include "haptic_server/server/session/result_files.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>

#include "common/base/user_error.h"
#include "haptic_server/core/tick/tick_choices.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

std::string textOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// What is in a file's name on any system.
std::string plainName(const fs::path& scene) {
    std::string name;
    for (const char letter : scene.stem().string())
        name += std::isalnum(static_cast<unsigned char>(letter)) || letter == '-' ? letter : '_';
    return name.substr(0, 64);
}

std::string utcNow() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%dT%H%M%SZ", &utc);
    return text;
}

void addShape(const BoneModel& bone, journal::Manifest& manifest) {
    for (int axis = 0; axis < 3; ++axis) {
        manifest.add_leaf_cells(uint32_t(bone.lattice.leafCells()[axis]));
        manifest.add_voxels(uint32_t(bone.volume.dims()[axis]));
    }
}

constexpr int kMaxNumbers = 100'000;

std::vector<NamedFile> resultsOf(const ServerOptions& options) {
    std::vector<NamedFile> files = filesOf(options.save);
    files.push_back({"--trace", options.trace});
    files.push_back({"--report", options.report});
    return files;
}

// Links count for what they are: also one that leads nowhere yet is somebody's.
bool isThere(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

bool isDevice(const std::string& path) {
    std::error_code error;
    return fs::exists(path, error) && !fs::is_regular_file(path, error);
}

std::string withNumber(const std::string& path, int number) {
    if (path.empty() || isDevice(path)) return path;
    fs::path file(path);
    file.replace_filename(file.stem().string() + "_" + std::to_string(number) + file.extension().string());
    return file.string();
}

}  // namespace

fs::path defaultRecordingFolder() {
    const std::string state = variable("XDG_STATE_HOME"), home = variable("HOME");
    if (!state.empty()) return fs::path(state) / "bonemill" / "recordings";
    return home.empty() ? fs::path() : fs::path(home) / ".local" / "state" / "bonemill" / "recordings";
}

void requireRecordable(const ServerOptions& options) {
    if (!options.is_recorded) return;
    if (options.recording.empty())
        throw UserError(
            "there is no folder for the recording, for neither XDG_STATE_HOME nor HOME is set; name one "
            "with --recording, or refuse it with --no-recording");
    std::error_code error;
    fs::create_directories(options.recording, error);
    if (error || access(options.recording.c_str(), W_OK | X_OK) != 0)
        throw UserError(
            "--recording " + options.recording +
            ": nothing can be written there; name another folder, or refuse it with --no-recording");
}

fs::path newJournalPath(const fs::path& folder, uint32_t session, const fs::path& scene) {
    const std::string name = std::to_string(session) + "_" + plainName(scene) + "_" + utcNow();
    fs::path path = folder / (name + ".mcap");
    std::error_code error;
    for (int number = 2; fs::exists(fs::symlink_status(path, error)); ++number)
        path = folder / (name + "_" + std::to_string(number) + ".mcap");
    return path;
}

JournalConfig journalConfigOf(const ServerOptions& options, const LoadedScene& loaded,
                              const SceneSetup& simulation) {
    JournalConfig config;
    config.recorded = recordedEffectsOf(loaded.scene.effects());
    config.rate_hz = loaded.scene.loop().rate_hz();
    config.with_results = options.records_results;
    journal::Manifest& manifest = config.manifest;
    manifest.set_journal_id(newJournalId());
    manifest.set_session(options.session);
    *manifest.mutable_build() = buildFacts(options.version);
    manifest.set_scene_path(fs::absolute(loaded.file).lexically_normal());
    manifest.set_scene_text(textOf(loaded.file));
    manifest.set_scene_name(loaded.scene.name());
    manifest.set_scene_hash(sceneHashOf(loaded.scene));
    manifest.set_rate_hz(config.rate_hz);
    for (journal::File& file : hashedFiles(filesOf(loaded))) *manifest.add_files() = std::move(file);
    for (const SceneTool& tool : simulation.tools) manifest.add_tool_names(tool.name);
    const AccuracySwitch accuracy(simulation.accuracy);
    for (size_t choice = 0; choice < AccuracySwitch::count(); ++choice)
        manifest.add_accuracy_names(settingsName(accuracy[choice]));
    manifest.set_records_burr(config.recorded.burr);
    manifest.set_records_heat(config.recorded.heat);
    manifest.set_records_protection(config.recorded.protection);
    for (const std::string& name : materialNamesOf(loaded.scene)) manifest.add_material_names(name);
    addShape(*simulation.bone, manifest);
    return config;
}

ResultFiles::ResultFiles(ServerOptions session, std::vector<NamedFile> read)
    : session_(std::move(session)), taken_(std::move(read)) {
    std::vector<NamedFile> written = resultsOf(session_);
    written.push_back({"--class-table", session_.class_table});
    requireApart(written, taken_);
    taken_.insert(taken_.end(), written.begin(), written.end());
}

ServerOptions ResultFiles::next(const std::string& scene) const {
    for (int number = last_ + 1; number < last_ + kMaxNumbers; ++number) {
        ServerOptions options = numbered(scene, number);
        if (isFree(options)) return options;
    }
    throw UserError("there is no free name for the files of another scene; tidy up their folders");
}

void ResultFiles::take(const ServerOptions& options) {
    last_ = options.scene_number;
    const std::vector<NamedFile> written = resultsOf(options);
    taken_.insert(taken_.end(), written.begin(), written.end());
}

ServerOptions ResultFiles::numbered(const std::string& scene, int number) const {
    ServerOptions options = session_;
    options.scene = scene;
    options.scene_number = number;
    options.accuracy.clear();  // it was measured in the first one
    options.resumed_journal.clear();
    for (std::string* path : std::array{&options.trace, &options.report, &options.save.volume,
                                        &options.save.mesh, &options.save.difference})
        *path = withNumber(*path, number);
    return options;
}

bool ResultFiles::isFree(const ServerOptions& options) const {
    return std::ranges::none_of(resultsOf(options), [this](const NamedFile& file) {
        if (file.path.empty() || isDevice(file.path.string())) return false;
        return isThere(file.path) || std::ranges::any_of(taken_, [&](const NamedFile& other) {
                   return !other.path.empty() && isSameFile(file.path, other.path);
               });
    });
}

}  // namespace bonemill
