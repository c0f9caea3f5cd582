#include "render_client/case_window/case_desk/folder_view.h"

#include <algorithm>
#include <array>

#include "haptic_server/scans/archive/scan_endings.h"

namespace bonemill {
namespace {

constexpr std::array<const char*, 5> kOtherEndings = {".dcm", ".stl", ".ply", ".ima", "dicomdir"};

bool looksLikeScan(const std::string& name) {
    return endsLike(name, kVolumeEndings) || endsLike(name, kArchiveEndings) || endsLike(name, kOtherEndings);
}

}  // namespace

FolderView lookInto(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    FolderView view;
    view.path = fs::absolute(folder, error).lexically_normal();
    if (!view.path.has_filename() && view.path.has_relative_path()) view.path = view.path.parent_path();
    fs::directory_iterator entry(view.path, error);
    if (error) view.problem = error.message();
    for (size_t seen = 0; !error && entry != fs::directory_iterator() && seen < kMaxShownEntries; ++seen) {
        const std::string name = entry->path().filename().string();
        std::error_code ignored;
        if (name.starts_with('.')) {
        } else if (entry->is_directory(ignored)) {
            view.folders.push_back(name);
        } else if (looksLikeScan(name)) {
            view.scans.push_back(name);
        } else {
            ++view.other_files;
        }
        entry.increment(error);
    }
    std::ranges::sort(view.folders);
    std::ranges::sort(view.scans);
    return view;
}

}  // namespace bonemill
