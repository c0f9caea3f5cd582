#include "haptic_server/server/session/result_files.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

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
