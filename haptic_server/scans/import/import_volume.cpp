#include "haptic_server/scans/import/import_volume.h"

#include <spawn.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/scans/confined/guarded_import.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/import/packed_scan.h"

namespace bonemill {
namespace {

using nlohmann::json;

// These words stand behind the program's name, and before the path.
constexpr char kReadVolumeWord[] = "read-volume";  // then the options
constexpr char kReadSeriesWord[] = "read-series";
constexpr char kUnpackWord[] = "unpack-scan";

// As one word, for the program that reads.
std::string textOfOptions(const ImportOptions& options) {
    json text = {{"series_uid", options.series_uid},
                 {"acquisition", options.acquisition},
                 {"surface_value", options.surface_value}};
    if (options.surface_voxel_mm) text["surface_voxel_mm"] = *options.surface_voxel_mm;
    if (options.spacing_mm)
        text["spacing_mm"] = {options.spacing_mm->x(), options.spacing_mm->y(), options.spacing_mm->z()};
    return text.dump(-1, ' ', false, json::error_handler_t::replace);  // no UID has what is replaced
}

// Throws nlohmann::json::exception for what textOfOptions() has not written.
ImportOptions optionsFromText(const std::string& text) {
    const json from = json::parse(text);
    ImportOptions options;
    options.series_uid = from.at("series_uid").get<std::string>();
    options.acquisition = from.at("acquisition").get<std::string>();
    options.surface_value = from.at("surface_value").get<double>();
    if (from.contains("surface_voxel_mm")) options.surface_voxel_mm = from["surface_voxel_mm"].get<double>();
    if (from.contains("spacing_mm"))
        options.spacing_mm = Eigen::Vector3d(from["spacing_mm"].get<std::array<double, 3>>().data());
    return options;
}

// The reader finds the ends of the pipe and of the name there.
constexpr int kPipe = 3, kName = 4;

std::string reader_program;  // empty: none

// With CLOEXEC ends above those numbers nothing else of this process's files is left open in the reader.
pid_t spawn(std::vector<std::string> words, int pipe, int name) {
    std::vector<char*> raw;
    for (std::string& word : words) raw.push_back(word.data());
    raw.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    // The copies go through numbers that neither end can have.
    constexpr int kFarPipe = 200, kFarName = 201;
    posix_spawn_file_actions_adddup2(&actions, pipe, kFarPipe);
    if (name >= 0) posix_spawn_file_actions_adddup2(&actions, name, kFarName);
    posix_spawn_file_actions_adddup2(&actions, kFarPipe, kPipe);
    if (name >= 0) posix_spawn_file_actions_adddup2(&actions, kFarName, kName);
    posix_spawn_file_actions_addclosefrom_np(&actions, kName + (name >= 0 ? 1 : 0));
    pid_t child = -1;
    if (posix_spawn(&child, words[0].c_str(), &actions, nullptr, raw.data(), environ) != 0) child = -1;
    posix_spawn_file_actions_destroy(&actions);
    return child;
}

StartReader spawnReader(const std::vector<std::string>& words) {
    return [words](int pipe, int name) { return spawn(words, pipe, name); };
}

// The scenes of deploy/scenes read what deploy/make-phantoms puts into build/data.
bool isPhantom(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.lexically_normal().parent_path();
    return folder.filename() == "data" && folder.parent_path().filename() == "build";
}

void requireThere(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw UserError(path.string() + ": no such file or folder; " +
                        (isPhantom(path) ? "deploy/make-phantoms makes it" : "check the path of the volume"));
    requireFile(path);
}

StartReader startUnpacking(const std::filesystem::path& path) {
    if (reader_program.empty()) return forkOf([=](int pipe) { sendPackedAsChild(pipe, path); });
    return spawnReader({reader_program, kUnpackWord, path.string()});
}

RawVolume importPlain(const std::filesystem::path& path, const ImportOptions& options) {
    if (reader_program.empty()) return importGuarded(path, [&] { return importVolumeHere(path, options); });
    return importFrom(path,
                      spawnReader({reader_program, kReadVolumeWord, path.string(), textOfOptions(options)}));
}

Lines listPlain(const std::filesystem::path& path) {
    if (reader_program.empty()) return linesGuarded(path, [&] { return listSeriesHere(path); });
    return linesFrom(path, spawnReader({reader_program, kReadSeriesWord, path.string()}));
}

// What `read` returns of the scan; of one out of an archive, with the texts that `rename` has named anew.
template <class Result>
Result ofUnpacked(const std::filesystem::path& path, const auto& read, const auto& rename) {
    if (!isPacked(path)) return read(path);
    Result result;
    readUnpacked(path, startUnpacking(path), [&](const std::filesystem::path& scan, const auto& named) {
        result = read(scan);
        rename(result, named);
    });
    return result;
}

}  // namespace

void setReaderProgram(const std::string& program) {
    reader_program = program;
}

// A path may look like an option, so that no parser of options sees it.
void runReaderIfCalled(int argc, char** argv) {
    const std::vector<std::string> words(argv, argv + argc);
    if (argc == 4 && words[1] == kReadVolumeWord) {
        shareNameOfFileBeingRead(kName);
        readAsChild(kPipe, words[2], [&] { return importVolumeHere(words[2], optionsFromText(words[3])); });
    }
    if (argc == 3 && words[1] == kReadSeriesWord) {
        shareNameOfFileBeingRead(kName);
        readLinesAsChild(kPipe, words[2], [&] { return listSeriesHere(words[2]); });
    }
    if (argc == 3 && words[1] == kUnpackWord) {
        shareNameOfFileBeingRead(kName);
        sendPackedAsChild(kPipe, words[2]);
    }
}

RawVolume importVolume(const std::filesystem::path& path, const ImportOptions& options) {
    return ofUnpacked<RawVolume>(
        path, [&](const std::filesystem::path& scan) { return importPlain(scan, options); },
        [](RawVolume& raw, const auto& named) { raw.description = named(raw.description); });
}

RawVolume importVolumeHere(const std::filesystem::path& path, const ImportOptions& options) {
    requireThere(path);
    RawVolume raw = readVolume(path, options);
    if (raw.lacks_patient_axes)
        raw.description +=
            "; nothing in it says how the patient lay: its axes are taken for those to the left, the back "
            "and "
            "the head, and left and right may be exchanged";
    const size_t count = raw.values.range().non_finite;
    if (count > 0) raw.description += "; " + std::to_string(count) + " values are not finite";
    return raw;
}

std::vector<std::string> listSeries(const std::filesystem::path& path) {
    return ofUnpacked<Lines>(path, listPlain, [](Lines& lines, const auto& named) {
        for (std::string& line : lines) line = named(line);
    });
}

std::vector<std::string> listSeriesHere(const std::filesystem::path& path) {
    requireThere(path);
    return readSeries(path);
}

}  // namespace bonemill
