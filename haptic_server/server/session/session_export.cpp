#include "haptic_server/server/session/session_export.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <vector>

#include "common/base/is_ready.h"
#include "common/base/user_error.h"
#include "common/files/whole_file.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestName = 64;
constexpr const char* kProbe = ".bonemill_export";

bool isName(const std::string& name) {
    const auto is_allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-' || c == '.';
    };
    return !name.empty() && name.size() <= kLongestName && name[0] != '.' && name[0] != '-' &&
           std::all_of(name.begin(), name.end(), is_allowed);
}

struct Files {
    fs::path stl, ply, volume, difference;

    Files(const fs::path& folder, const std::string& name)
        : stl(folder / (name + ".stl")),
          ply(folder / (name + ".ply")),
          volume(folder / (name + ".nrrd")),
          difference(folder / (name + "_difference.nrrd")) {}
    std::vector<fs::path> all() const { return {stl, ply, volume, difference}; }
};

// All of them get their names, or none.
class Writing {
  public:
    ~Writing() {
        std::error_code ignored;
        for (const fs::path& path : finished_) fs::remove(path, ignored);
    }
    void write(const fs::path& path, const std::function<void(const std::string&)>& save) {
        files_.emplace_back(path);
        save(files_.back().part());
    }
    void finish() {
        for (WholeFile& file : files_) {
            file.finish();
            finished_.push_back(file.path());
        }
        finished_.clear();
    }

  private:
    std::deque<WholeFile> files_;
    std::vector<fs::path> finished_;  // while others are not
};

void writeAll(const Files& files, const VoxelVolume& volume, const VoxelVolume& scanned,
              const Eigen::Vector3i& leaf_cells) {
    const LeafLattice lattice(volume, leaf_cells);
    const std::vector<NodeMesh> meshes = meshWholeBone(volume, lattice);
    Writing writing;
    const auto save_mesh = [&](const std::string& path) { saveMesh(path, volume, lattice, meshes); };
    writing.write(files.stl, save_mesh);
    writing.write(files.ply, save_mesh);
    writing.write(files.volume, [&](const std::string& path) { writeNrrd(path, volume); });
    writing.write(files.difference, [&](const std::string& path) { saveDifference(path, scanned, volume); });
    writing.finish();
}

}  // namespace

SessionExport::SessionExport(BoneHistory& history, const BoneModel& bone, std::string folder)
    : history_(history), bone_(bone), folder_(std::move(folder)) {
    if (folder_.empty()) return;
    if (!fs::is_directory(folder_))
        throw UserError("--export-dir " + folder_ + ": no such folder; make it first");
    requireWritable((fs::path(folder_) / kProbe).string());
}

std::optional<Answer> SessionExport::begin(const std::string& name) {
    if (folder_.empty()) return Answer::refused("this server was started without --export-dir");
    if (!isName(name))
        return Answer::refused("'" + repeatedText(name) +
                               "' is no name for files: letters, digits, _ - and . (not first), " +
                               std::to_string(kLongestName) + " at most");
    if (result_.valid()) return Answer::refused("an export is under way; wait for its end");
    const Files files(folder_, name);
    std::error_code ignored;
    for (const fs::path& file : files.all())
        if (fs::exists(file, ignored))
            return Answer::refused(file.filename().string() + " is there already; give another name");
    try {
        result_ = std::async(std::launch::async, [this, files, snapshot = history_.snapshot(bone_)] {
            Answer result = Answer::done();
            try {
                writeAll(files, history_.volumeOf(*snapshot, bone_.lattice), history_.scanned(),
                         bone_.lattice.leafCells());
            } catch (const std::exception& error) {
                result = Answer::failed(error.what());
            }
            spdlog::info("export {}: {}", files.volume.stem().string(), result.text);
            return result;
        });
    } catch (const std::exception& error) {
        return Answer::refused(std::string("no memory or thread for it: ") + error.what());
    }
    return std::nullopt;
}

std::optional<Answer> SessionExport::takeResult() {
    if (!isReady(result_)) return std::nullopt;
    return result_.get();
}

}  // namespace bonemill
