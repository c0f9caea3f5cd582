// What reads volumes in this build: every_reader.cpp, or nrrd_reader.cpp where it has no readers of scans.
// For the reader's process (import_program.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/scans/import/import_volume.h"

namespace bonemill {

// The file or folder is there. Both throw UserError with one message that names it.
RawVolume readVolume(const std::filesystem::path& path, const ImportOptions& options);
std::vector<std::string> readSeries(const std::filesystem::path& path);

}  // namespace bonemill
