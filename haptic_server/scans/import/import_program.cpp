#include "haptic_server/scans/import/import_program.h"

#include <spawn.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/guarded_import.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/import/import_options_text.h"

namespace bonemill {
namespace {

// The reader finds the ends of the pipe and of the name there.
constexpr int kPipe = 3, kName = 4;

std::string reader_program;  // empty: none

// With CLOEXEC ends above those numbers nothing else of this process's files is left open in the reader.
pid_t spawnReader(std::vector<std::string> words, int pipe, int name) {
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

}  // namespace

void setReaderProgram(const std::string& program) {
    reader_program = program;
}

bool hasReaderProgram() {
    return !reader_program.empty();
}

RawVolume importByProgram(const std::filesystem::path& path, const ImportOptions& options) {
    std::vector<std::string> words{reader_program, kReadVolumeWord, path.string(), textOfOptions(options)};
    return importFrom(path, [&](int pipe, int name) { return spawnReader(words, pipe, name); });
}

std::vector<std::string> listByProgram(const std::filesystem::path& path) {
    std::vector<std::string> words{reader_program, kReadSeriesWord, path.string()};
    return linesFrom(path, [&](int pipe, int name) { return spawnReader(words, pipe, name); });
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
}

}  // namespace bonemill
