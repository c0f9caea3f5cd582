// What names of scans end with. Pure; any thread may call it, it allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <span>
#include <string>

namespace bonemill {

// A file of its own is the whole volume.
inline constexpr std::array<const char*, 7> kVolumeEndings = {".nrrd", ".nhdr", ".nii", ".nii.gz",
                                                              ".mha",  ".mhd",  ".inv3"};
inline constexpr std::array<const char*, 5> kArchiveEndings = {".zip", ".tar", ".tar.gz", ".tgz", ".tar.xz"};

// In letters of either case.
inline bool endsLike(const std::filesystem::path& file, std::span<const char* const> endings) {
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return std::ranges::any_of(endings, [&](const char* ending) { return name.ends_with(ending); });
}

}  // namespace bonemill
