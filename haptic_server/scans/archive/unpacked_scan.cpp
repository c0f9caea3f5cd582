#include "haptic_server/scans/archive/unpacked_scan.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/archive/scan_endings.h"
#include "haptic_server/scans/archive/unpack_archive.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr char kFolderName[] = "bonemill_scan_";

int lockOf(const fs::path& folder) {
    const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    if (file >= 0) close(file);
    return -1;
}

// One that is just made may not be locked yet.
bool isOld(const fs::path& folder) {
    std::error_code error;
    const auto written = fs::last_write_time(folder, error);
    return !error && fs::file_time_type::clock::now() - written > std::chrono::minutes(1);
}

// Those of others cannot be opened, or not be removed.
void removeLeftBehind(const fs::path& place) {
    std::error_code error, ignored;
    for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error)) {
        if (!entry->path().filename().string().starts_with(kFolderName) || !isOld(entry->path())) continue;
        const int lock = lockOf(entry->path());
        if (lock < 0) continue;
        fs::remove_all(entry->path(), ignored);
        close(lock);
    }
}

fs::path newFolder() {
    std::error_code error;
    const fs::path place = fs::temp_directory_path(error);
    removeLeftBehind(place);
    std::string name = (place / (std::string(kFolderName) + "XXXXXX")).string();
    if (error || !mkdtemp(name.data()))
        throw UserError("cannot make a folder for what is unpacked in " +
                        (error ? "the folder that TMPDIR names" : place.string()) +
                        "; let TMPDIR name another one");
    return name;
}

std::vector<fs::path> volumesIn(const fs::path& folder) {
    std::vector<fs::path> volumes;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && endsLike(entry.path(), kVolumeEndings))
            volumes.push_back(entry.path());
    std::ranges::sort(volumes);
    return volumes;
}

fs::path outermost(fs::path folder) {
    for (;;) {
        const std::vector<fs::directory_entry> entries(fs::directory_iterator(folder), {});
        if (entries.size() != 1 || !entries.front().is_directory()) return folder;
        folder = entries.front().path();
    }
}

fs::path scanIn(const fs::path& folder, const fs::path& archive) {
    const std::vector<fs::path> volumes = volumesIn(folder);
    if (volumes.size() == 1) return volumes.front();
    if (volumes.empty()) return outermost(folder);
    const auto shown = [&](size_t n) { return printable(volumes[n].lexically_relative(folder).string()); };
    throw UserError(archive.string() + ": holds " + std::to_string(volumes.size()) + " volumes (" + shown(0) +
                    ", " + shown(1) + (volumes.size() > 2 ? ", ..." : "") +
                    "); unpack it, and give one of them");
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
}

}  // namespace

PassingFolder::PassingFolder() : path_(newFolder()), lock_(lockOf(path_)) {}

PassingFolder::~PassingFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    if (lock_ >= 0) close(lock_);
}

UnpackedScan::UnpackedScan(const fs::path& archive, const StartReader& start) : archive_(archive) {
    unpackArchive(archive, folder_.path(), start);
    scan_ = scanIn(folder_.path(), archive_);
}

std::string UnpackedScan::named(std::string text) const {
    replaceAll(text, folder_.path().string() + "/", archive_.string() + ": ");
    replaceAll(text, folder_.path().string(), archive_.string());
    return text;
}

}  // namespace bonemill
