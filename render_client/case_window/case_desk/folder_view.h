// What a folder offers to whoever looks for a scan. Any thread may call it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bonemill {

struct FolderView {
    std::filesystem::path path;  // absolute
    std::vector<std::string> folders;
    std::vector<std::string> scans;  // files whose ending we read
    size_t other_files = 0;          // slices of a DICOM series have often no ending
    std::string problem;             // why it cannot be looked into; empty: it can
};

inline constexpr size_t kMaxShownEntries = 2000;

// Hidden entries are left out; the lists are in alphabetical order. Does not throw.
FolderView lookInto(const std::filesystem::path& folder);

}  // namespace bonemill
