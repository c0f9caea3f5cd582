// Unpacks a zip or tar archive into a folder. A process that can do nothing else looks into the archive
// (guarded_process.h); this one writes what comes of it, and believes nothing: it writes plain files only,
// within the folder, no more and no larger than the limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "haptic_server/scans/confined/guarded_process.h"

namespace bonemill {

// A CT of a whole body in the finest slices stays well within them.
struct ArchiveLimits {
    size_t files = 20'000;
    uint64_t bytes = uint64_t(8) << 30;
};

// By its name (.zip, .tar, .tar.gz, .tgz, .tar.xz), or a zip of any name.
bool isArchive(const std::filesystem::path& path);

// For the child: hands over the archive's files, and ends the process.
[[noreturn]] void sendArchiveAsChild(int pipe, const std::filesystem::path& path);

// `start` starts a process that calls sendArchiveAsChild(). Hidden files, and what macOS adds, are left out.
// Throws UserError with one line that names the archive: it is encrypted, cut short, damaged, holds links or
// names that lead out of the folder, or more than the limits. Then the folder may hold a part.
void unpackArchive(const std::filesystem::path& path, const std::filesystem::path& folder,
                   const StartReader& start, const ArchiveLimits& limits = {});

}  // namespace bonemill
